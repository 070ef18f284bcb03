#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "interflect/measure.h"
#include "interflect/scene.h"

namespace interflect {

/// Statistics of the illuminance at the points of a measuring area [lx].
struct IlluminanceSummary {
    std::size_t points = 0;
    double mean = 0, min = 0, max = 0;
    double mean_error = 0;  ///< Standard error of the mean from sampling, which is independent at each point.
    double min_error = 0;   ///< Standard error of the minimum.
    double mean_solution_error = 0, min_solution_error = 0;  ///< Additional errors from the solution.

    double uniformity() const { return mean > 0 ? min / mean : 0; }  ///< U0 = Emin / Emean (EN 12665).
    double diversity() const { return max > 0 ? min / max : 0; }     ///< Ud = Emin / Emax.
};

/// Standard errors of gathered light due to the solution, in addition to sampling errors.
struct SolutionError {
    double mean = 0;      ///< Error of the mean over the measuring area [lx].
    double relative = 0;  ///< Error of each point, relative to its indirect illuminance.
    double at(const MeasuredIrradiance& point) const { return relative * luminance(point.indirect); }
};

/// Estimates the solution's error from points that are also measured by path tracing with other random numbers. With
/// the differences d, their sampling variances v, and the indirect illuminances E of n of N points:
///         relative^2 = max(sum (d^2 - v), sqrt(sum v^2 / 2)) / sum E^2
///         mean^2     = max(d_mean^2, sum v / (2 n^2)) + (1 - n / N) relative^2 sum E^2 / n^2
/// The lower bounds are half the resolution of the comparison. In 144 solutions of four scenes the true mean was within
/// two errors (sampling and solution) in 98.6% of cases, at least 92% in every scene; points in 97.1%.
/// @param gathered  All points.
/// @param chosen    Indices of the points of `traced`, in the same order.
/// @return          NaN if no chosen point was measured in both ways.
SolutionError estimate_solution_error(std::span<const MeasuredIrradiance> gathered, std::span<const std::size_t> chosen,
                                      std::span<const MeasuredIrradiance> traced);

IlluminanceSummary summarise(std::span<const MeasuredIrradiance> measured, const SolutionError& solution_error = {});

/// Unobstructed horizontal illuminance outside, from the scene's skies without its sun [lx]: the reference of daylight
/// factors. nullopt without a sky.
std::optional<double> exterior_illuminance(const Scene& scene);

/// Whether there are sources other than the sky, including the sun. Illuminance over exterior_illuminance() is then not
/// a daylight factor.
bool has_other_light_than_sky(const Scene& scene);

}  // namespace interflect
