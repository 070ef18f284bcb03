#pragma once

#include "interflect/colour.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Where the power that a scene emits ends up, channel by channel [lm or W].
struct PowerBalance {
    RgbD emitted{0, 0, 0};   ///< By surfaces, and by luminaires into the scene.
    RgbD absorbed{0, 0, 0};  ///< Sum of (1 - rho - tau) H A, by the solution's mean.
    RgbD escaped{0, 0, 0};   ///< Through openings, averaged as irradiance is.

    /// What is left over, relative to what is emitted; 0 where nothing is. All channels together.
    double relative_difference() const;
};

/// Of a solution of the scene. Noise of averaged iterations, and what the last pass left unshot, show in the
/// difference. O(elements).
PowerBalance power_balance(const Scene& scene, const Solution& solution);

}  // namespace interflect
