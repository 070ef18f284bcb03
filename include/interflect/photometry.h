#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "interflect/measure.h"
#include "interflect/scene.h"

namespace interflect {

/// What the points of a measuring area have in common: luminances of the colours [lx].
struct IlluminanceSummary {
    std::size_t points = 0;
    double mean = 0, min = 0, max = 0;
    double mean_error = 0;  ///< Standard error of the mean; that of the points is independent.
    double min_error = 0;   ///< Of the darkest point.

    double uniformity() const { return mean > 0 ? min / mean : 0; }  ///< U0 = Emin / Emean (EN 12665).
    double diversity() const { return max > 0 ? min / max : 0; }     ///< Ud = Emin / Emax.
};

IlluminanceSummary summarise(std::span<const MeasuredIrradiance> measured);

/// Horizontal illuminance outside, without any obstruction, of the scene's skies and not of its sun, which daylight
/// factors are relative to [lx]; none where it has no sky.
std::optional<double> exterior_illuminance(const Scene& scene);

/// Whether anything but the sky shines, the sun too: illuminance over exterior_illuminance() is then no daylight
/// factor.
bool has_other_light_than_sky(const Scene& scene);

}  // namespace interflect
