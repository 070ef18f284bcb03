#include "interflect/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interflect/core.h"
#include "interflect/photometry/planar_outline.h"

namespace interflect {

using namespace detail;

namespace {

using V2d = Imath::V2d;

/// Relative rounding error that must not add a cell.
constexpr double rounding = 1e-5;

void require_valid(const GridOptions& options) {
    if (options.spacing && !(*options.spacing > 0 && std::isfinite(*options.spacing)))
        throw InputError(fmt::format("a spacing of {} m: expected more than 0", *options.spacing));
    if (!(options.boundary >= 0 && std::isfinite(options.boundary)))
        throw InputError(fmt::format("a boundary strip of {} m: expected 0 or more", options.boundary));
}

int cell_count(double side, double spacing, const std::string& name) {
    const double count = std::max(1.0, std::ceil(side / spacing * (1 - rounding)));
    if (count > static_cast<double>(max_measuring_points))
        throw InputError(
            fmt::format("'{}': {:.3g} measuring points a row, expected at most {}", name, count, max_measuring_points));
    return static_cast<int>(count);
}

}  // namespace

double grid_spacing(double length, double width) {
    constexpr double largest = 10, ratio = 2;
    const auto [shorter, longer] = std::minmax(length, width);
    const double d = longer >= ratio * shorter ? shorter : longer;
    return std::min(largest, 0.2 * std::pow(5, std::log10(d)));
}

MeasuringGrid area_grid(const Scene& scene, const PlanarArea& area, const GridOptions& options,
                        const std::optional<double>& height) {
    require_valid(options);
    // Divide the rectangle around the area, less the boundary strip, into cells.
    const PlanarOutline outline = outline_of(scene, area);
    const V2d low = outline.box.min + V2d(options.boundary), sides = outline.box.max - V2d(options.boundary) - low;
    if (!(sides.x > 0 && sides.y > 0))
        throw InputError(fmt::format("'{}' is {:.3g} x {:.3g} m: a boundary strip of {:.3g} m covers all of it",
                                     area.name, outline.box.size().x, outline.box.size().y, options.boundary));
    const double spacing = options.spacing.value_or(grid_spacing(sides.x, sides.y));
    MeasuringGrid grid{.name = area.name, .normal = area.normal};
    grid.columns = cell_count(sides.x, spacing, area.name);
    grid.rows = cell_count(sides.y, spacing, area.name);
    if (static_cast<double>(grid.columns) * grid.rows > static_cast<double>(max_measuring_points))
        throw InputError(fmt::format("'{}': {} x {} measuring points, expected at most {}", area.name, grid.columns,
                                     grid.rows, max_measuring_points));
    grid.column_spacing = sides.x / grid.columns;
    grid.row_spacing = sides.y / grid.rows;
    grid.along_row = outline.u;
    grid.along_column = outline.v;
    const auto raised = [&](const Imath::V3d& p) { return height ? Imath::V3d(p.x, p.y, *height) : p; };
    grid.corner = raised(outline.point(low));

    // Keep the cell centres within the faces.
    const std::vector<PlanarSegment> border = options.boundary > 0 ? outline.border() : std::vector<PlanarSegment>();
    const auto is_within = [&](const V2d& p) {
        return outline.holds(p) && std::all_of(border.begin(), border.end(), [&](const PlanarSegment& s) {
                   return distance(p, s) >= options.boundary * (1 - rounding);
               });
    };
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const V2d p = low + V2d((column + 0.5) * grid.column_spacing, (row + 0.5) * grid.row_spacing);
            if (!is_within(p)) continue;
            grid.points.push_back(raised(outline.point(p)));
            grid.cells.push_back(static_cast<std::uint32_t>(row * grid.columns + column));
        }
    if (grid.points.empty())
        throw InputError(
            fmt::format("'{}': no point of the grid of {} x {} lies within it, expected a smaller "
                        "spacing or boundary strip",
                        area.name, grid.columns, grid.rows));
    return grid;
}

MeasuringGrid line_grid(const Imath::V3d& a, const Imath::V3d& b, int count) {
    if (count < 2 || static_cast<std::size_t>(count) > max_measuring_points)
        throw InputError(fmt::format("a line of {} points: expected 2 to {}", count, max_measuring_points));
    if (!((b - a).length() > 0)) throw InputError("a line whose ends are one point: expected two");
    MeasuringGrid grid{.name = "line"};
    grid.column_spacing = (b - a).length() / (count - 1);
    for (int i = 0; i < count; ++i) grid.points.push_back(a + (b - a) * (static_cast<double>(i) / (count - 1)));
    return grid;
}

}  // namespace interflect
