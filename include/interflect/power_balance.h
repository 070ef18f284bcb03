#pragma once

#include "interflect/colour.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Balance of the emitted power, per channel [lm or W].
struct PowerBalance {
    RgbD emitted{0, 0, 0};   ///< By surfaces, and by luminaires into the scene.
    RgbD absorbed{0, 0, 0};  ///< Sum of (1 - rho - tau) H A, with H from the solution.
    RgbD escaped{0, 0, 0};   ///< Through openings, averaged as irradiance is.

    /// Unaccounted power, relative to emitted power, summed over all channels; 0 without emission.
    double relative_difference() const;
};

/// Power balance of a solution of the scene. The difference contains the noise of averaged iterations and the power
/// left unshot by the last pass. O(elements).
PowerBalance power_balance(const Scene& scene, const Solution& solution);

}  // namespace interflect
