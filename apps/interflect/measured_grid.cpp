#include "apps/interflect/measured_grid.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <functional>
#include <span>
#include <utility>

#include "apps/interflect/path_progress.h"
#include "interflect/checks/measuring_places.h"
#include "interflect/error.h"
#include "interflect/photometry.h"

namespace interflect::command {

namespace {

/// @param is_meant  Whether the warning is about the point of this index.
void warn_of_points(std::span<const MeasuringPoint> points, const char* what,
                    const std::function<bool(std::size_t)>& is_meant) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = points.size(); i-- > 0;)
        if (is_meant(i)) ++count, first = i;
    if (count == 0) return;
    const Imath::V3d& x = points[first].position;
    spdlog::warn("{} of {} measuring points {}, such as ({:.6g}, {:.6g}, {:.6g}); measure at another height or place",
                 count, points.size(), what, x.x, x.y, x.z);
}

}  // namespace

void warn_of_misplaced_points(const Scene& scene, const RayCaster& ray_caster, std::span<const MeasuringPoint> points,
                              std::span<const MeasuredIrradiance> measured) {
    const std::vector<PointFault> faults = point_faults(scene, ray_caster, points);
    warn_of_points(points, "lie outside of the scene", [&](std::size_t i) { return faults[i] == PointFault::outside; });
    warn_of_points(points, "lie inside solids or behind other one-sided faces",
                   [&](std::size_t i) { return faults[i] == PointFault::behind; });
    if (measured.empty()) return;
    const auto is_dark = [&](std::size_t i) {
        return faults[i] == PointFault::none && measured[i].is_measured() && measured[i].sum() == Rgb(0);
    };
    warn_of_points(points, "receive no light at all and probably lie inside solids or outside of the scene", is_dark);
}

std::vector<MeasuredGrid> measure_grids(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                        std::vector<MeasuringGrid> grids, const std::vector<MeasuringPoint>& points,
                                        const PathOptions& options) {
    std::vector<MeasuredIrradiance> measured;
    with_path_progress([&](const PathMonitor& monitor) {
        measured = measure_irradiance(scene, solution, ray_caster, points, options, monitor);
    });
    warn_of_misplaced_points(scene, ray_caster, points, measured);
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
