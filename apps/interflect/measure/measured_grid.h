#pragma once

#include <optional>
#include <span>
#include <vector>

#include "interflect/measure.h"

namespace interflect::command {

/// Measurements of a grid, reduced to the points that were reached.
struct MeasuredGrid {
    MeasuringGrid grid;
    std::vector<MeasuredIrradiance> measured;  ///< One per point.
    std::size_t missing = 0;                   ///< Points that were not reached.
    SolutionError solution_error;              ///< 0 without a solution.
};

/// Warns about points outside the scene, inside solids or without light.
/// @param measured  May be empty.
void warn_of_misplaced_points(const Scene& scene, const RayCaster& ray_caster, std::span<const MeasuringPoint> points,
                              std::span<const MeasuredIrradiance> measured);

/// Measures all grids with a progress bar, and estimates a solution's error by path tracing at about 256 points. Ctrl-C
/// ends it early with a partial result.
/// @param points  Points of all grids in order. @param solution  As in measure_irradiance().
/// @throws Stopped if no point was reached.
std::vector<MeasuredGrid> measure_grids(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                        std::vector<MeasuringGrid> grids, const std::vector<MeasuringPoint>& points,
                                        const MeasuringOptions& options);

/// Returns the exterior illuminance of daylight factors [lx]: `given`, or the sky's if the sky is the only light.
/// Warns if other light prevents daylight factors.
std::optional<double> exterior_of(const Scene& scene, const std::optional<double>& given);

}  // namespace interflect::command
