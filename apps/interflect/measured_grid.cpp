#include "apps/interflect/measured_grid.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "apps/interflect/path_progress.h"
#include "interflect/error.h"
#include "interflect/photometry.h"

namespace interflect::command {

std::vector<MeasuredGrid> measure_grids(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                        std::vector<MeasuringGrid> grids, const std::vector<MeasuringPoint>& points,
                                        const PathOptions& options) {
    std::vector<MeasuredIrradiance> measured;
    with_path_progress([&](const PathMonitor& monitor) {
        measured = measure_irradiance(scene, solution, ray_caster, points, options, monitor);
    });
    std::vector<MeasuredGrid> result;
    std::size_t next = 0, lost = 0;
    for (MeasuringGrid& grid : grids) {
        MeasuredGrid& of_grid = result.emplace_back();
        const std::vector<Imath::V3d> positions = std::exchange(grid.points, {});
        const std::vector<std::uint32_t> cells = std::exchange(grid.cells, {});
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const MeasuredIrradiance& e = measured[next++];
            if (!e.is_measured()) {
                ++of_grid.missing;
                ++lost;
                continue;
            }
            grid.points.push_back(positions[i]);
            if (!cells.empty()) grid.cells.push_back(cells[i]);
            of_grid.measured.push_back(e);
        }
        of_grid.grid = std::move(grid);
    }
    if (lost > 0 && lost == points.size()) throw Stopped("stopped before any point was measured");
    if (lost > 0) spdlog::warn("{} of {} points were not measured before the end", lost, points.size());
    return result;
}

std::optional<double> exterior_of(const Scene& scene, const std::optional<double>& told) {
    if (told) return told;
    const std::optional<double> exterior = exterior_illuminance(scene);
    if (exterior && has_other_light_than_sky(scene)) {
        spdlog::warn("not only the sky shines: no daylight factors (--exterior LUX gives them all the same)");
        return std::nullopt;
    }
    return exterior;
}

}  // namespace interflect::command
