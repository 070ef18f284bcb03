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
    double mean_error = 0;  ///< Standard error of the mean from sampling, which is independent at each point.
    double min_error = 0;   ///< Of the darkest point.
    double mean_solution_error = 0, min_solution_error = 0;  ///< The solution's parts, on top of these.

    double uniformity() const { return mean > 0 ? min / mean : 0; }  ///< U0 = Emin / Emean (EN 12665).
    double diversity() const { return max > 0 ? min / max : 0; }     ///< Ud = Emin / Emax.
};

/// Standard errors that the solution causes in gathered light, in addition to the errors of sampling.
struct SolutionError {
    double mean = 0;      ///< Error of the mean over the measuring area [lx].
    double relative = 0;  ///< Error of each point over its indirect illuminance.
    double at(const MeasuredIrradiance& point) const { return relative * luminance(point.indirect); }
};

/// Estimates the solution's error from some points that are also measured by path tracing, with other random numbers.
/// With the differences d, their sampling variances v, and the indirect illuminances E of n of N points:
///     relative^2 = max(sum (d^2 - v), sqrt(sum v^2 / 2)) / sum E^2
///     mean^2     = max(d_mean^2, sum v / (2 n^2)) + (1 - n / N) relative^2 sum E^2 / n^2
/// The lower bounds are half the resolution of the comparison. In 144 solutions of four scenes the true mean was within
/// two errors (sampling and solution) in 98.6% of cases, in no scene in less than 92%; points in 97.1%.
/// @param gathered  All points. @param chosen  Indices of the points of `traced`, which are in the same order.
/// @return          NaN where no chosen point was measured in both ways.
SolutionError estimate_solution_error(std::span<const MeasuredIrradiance> gathered, std::span<const std::size_t> chosen,
                                      std::span<const MeasuredIrradiance> traced);

IlluminanceSummary summarise(std::span<const MeasuredIrradiance> measured, const SolutionError& solution_error = {});

/// Horizontal illuminance outside, without any obstruction, of the scene's skies and not of its sun, which daylight
/// factors are relative to [lx]; none where it has no sky.
std::optional<double> exterior_illuminance(const Scene& scene);

/// Whether anything but the sky shines, the sun too: illuminance over exterior_illuminance() is then no daylight
/// factor.
bool has_other_light_than_sky(const Scene& scene);

}  // namespace interflect
