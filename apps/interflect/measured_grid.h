#pragma once

#include <optional>
#include <span>
#include <vector>

#include "interflect/measure.h"
#include "interflect/measuring_grid.h"
#include "interflect/photometry.h"

namespace interflect::command {

/// What was measured on one grid: only the points that were reached.
struct MeasuredGrid {
    MeasuringGrid grid;
    std::vector<MeasuredIrradiance> measured;  ///< Of grid.points.
    std::size_t missing = 0;                   ///< Points that were not reached.
    SolutionError solution_error;              ///< 0 without a solution.
};

/// Warns of points outside of the scene, inside solids and without any light.
/// @param measured  At the points; may be empty.
void warn_of_misplaced_points(const Scene& scene, const RayCaster& ray_caster, std::span<const MeasuringPoint> points,
                              std::span<const MeasuredIrradiance> measured);

/// Measures all grids with a progress bar, and about 256 of their points by path tracing too, for the solution error.
/// Ctrl-C ends it early with what there is.
/// @param points  Of all grids, one after the other. @param solution  As in measure_irradiance().
/// @throws Stopped if no point was reached.
std::vector<MeasuredGrid> measure_grids(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                        std::vector<MeasuringGrid> grids, const std::vector<MeasuringPoint>& points,
                                        const PathOptions& options);

/// Illuminance outside that daylight factors are relative to: as told, else that of the scene's sky if nothing else
/// shines [lx]; none: there are no daylight factors, which is said where there is a sky.
std::optional<double> exterior_of(const Scene& scene, const std::optional<double>& told);

}  // namespace interflect::command
