#include "apps/interflect/measure/measured_grid.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "apps/interflect/console/path_progress.h"
#include "interflect/core.h"
#include "interflect/measure.h"

namespace interflect::command {

using namespace detail;

namespace {

/// Warns about the points that `is_selected` selects by their indices.
void warn_of_points(std::span<const MeasuringPoint> points, const char* what,
                    const std::function<bool(std::size_t)>& is_selected) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = points.size(); i-- > 0;)
        if (is_selected(i)) {
            ++count;
            first = i;
        }
    if (count == 0) return;
    const Imath::V3d& x = points[first].position;
    spdlog::warn("{} of {} measuring points {}, such as ({:.6g}, {:.6g}, {:.6g}); measure at another height or place",
                 count, points.size(), what, x.x, x.y, x.z);
}

/// Numbers of points that are traced again to estimate the solution's error: in total, and at least in each grid.
constexpr std::size_t max_compared = 256, min_of_grid = 8;

/// Traces paths at evenly spread points of each grid, with the gathering's number of samples.
void compare_with_paths(SharedLight& shared_light, const Scene& scene, const RayCaster& ray_caster,
                        const std::vector<MeasuringPoint>& points, const std::vector<MeasuredIrradiance>& measured,
                        MeasuringOptions options, std::vector<MeasuredGrid>& grids) {
    options.shading = Shading::path;
    options.until = 0;
    ++options.seed;
    const std::size_t max_of_grid = std::max(min_of_grid, max_compared / grids.size());
    std::vector<std::vector<std::size_t>> chosen(grids.size());
    std::vector<MeasuringPoint> compared;
    std::size_t first = 0;
    for (std::size_t g = 0; g < grids.size(); ++g) {
        const std::size_t size = grids[g].grid.points.size(), count = std::min(size, max_of_grid);
        for (std::size_t k = 0; k < count; ++k) {
            chosen[g].push_back(k * size / count);
            compared.push_back(points[first + chosen[g].back()]);
        }
        first += size;
    }
    std::vector<MeasuredIrradiance> traced;
    with_path_progress(shared_light, [&](const Monitor& monitor) {
        traced = measure_irradiance(scene, nullptr, ray_caster, compared, options, monitor);
    });
    std::span<const MeasuredIrradiance> gathered = measured, rest = traced;
    for (std::size_t g = 0; g < grids.size(); ++g) {
        const std::size_t size = grids[g].grid.points.size();
        grids[g].solution_error =
            estimate_solution_error(gathered.first(size), chosen[g], rest.first(chosen[g].size()));
        gathered = gathered.subspan(size);
        rest = rest.subspan(chosen[g].size());
    }
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
        return faults[i] == PointFault::sound && measured[i].is_measured() && measured[i].sum() == Rgb(0);
    };
    warn_of_points(points,
                   "receive no light at all: they are in a room without light, inside a solid, or outside of the scene",
                   is_dark);
}

std::vector<MeasuredGrid> measure_grids(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                        std::vector<MeasuringGrid> grids, const std::vector<MeasuringPoint>& points,
                                        const MeasuringOptions& options) {
    SharedLight shared_light(scene, solution);
    std::vector<MeasuredIrradiance> measured;
    with_path_progress(shared_light, [&](const Monitor& monitor) {
        measured = measure_irradiance(scene, solution, ray_caster, points, options, monitor);
    });
    warn_of_misplaced_points(scene, ray_caster, points, measured);
    std::vector<MeasuredGrid> result;
    result.reserve(grids.size());
    for (MeasuringGrid& grid : grids) result.push_back({std::move(grid), {}, 0, {}});
    if (solution && !result.empty())
        compare_with_paths(shared_light, scene, ray_caster, points, measured, options, result);
    // Keep the points that were reached.
    std::size_t next = 0, lost = 0;
    for (MeasuredGrid& of_grid : result) {
        MeasuringGrid& grid = of_grid.grid;
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
    }
    if (lost > 0 && lost == points.size()) throw Stopped("stopped before any point was measured");
    if (lost > 0) spdlog::warn("{} of {} points were not measured before the end", lost, points.size());
    return result;
}

std::optional<double> exterior_of(const Scene& scene, const std::optional<double>& given) {
    if (given) return given;
    const std::optional<double> exterior = exterior_illuminance(scene);
    if (exterior && has_other_light_than_sky(scene)) {
        spdlog::warn("not only the sky shines: no daylight factors (--exterior LUX gives them all the same)");
        return std::nullopt;
    }
    return exterior;
}

}  // namespace interflect::command
