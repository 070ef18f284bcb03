#include "apps/interflect/measure/measuring_places.h"

#include <fmt/format.h>

#include "interflect/core.h"

namespace interflect::command {

namespace {

constexpr const char* places_group = "Where to measure (each may be repeated)";
constexpr const char* grid_group = "Grids";

}  // namespace

void GridArguments::add_to(CLI::App& app) {
    app.add_option("--spacing", spacing, "Largest distance between points [m] (default: by EN 12464-1)")
        ->type_name("METRES")
        ->check(number_between(1e-6, 1e15))
        ->group(grid_group);
    app.add_flag(fmt::format("--boundary{{{}}}", usual_boundary), boundary,
                 "Leave out a strip along the border: --boundary alone 0.5 m, --boundary=METRES another")
        ->check(number_between(0, 1e15))
        ->group(grid_group);
}

GridOptions GridArguments::options() const { return {spacing, boundary.empty() ? 0 : std::stod(boundary)}; }

void MeasuringPlaces::add_to(CLI::App& app) {
    const auto group = [](CLI::Option* option) {
        option->group(places_group);
        return option;
    };
    group(app.add_option("--grid", tops, "A grid on the top of an object: the floor of a room, the top of a desk")
              ->type_name("OBJECT")
              ->allow_extra_args(false));
    group(app.add_option("--plane", planes, "A horizontal grid at this height z [m], over the floor or over --over")
              ->type_name("HEIGHT")
              ->allow_extra_args(false)
              ->check(number_between(-1e15, 1e15)));
    group(app.add_option("--over", over, "The object, such as a room's floor, that --plane lies over")
              ->type_name("OBJECT"));
    group(app.add_option("--surface", surfaces, "A grid on the planar surface of an object, such as a wall")
              ->type_name("OBJECT")
              ->allow_extra_args(false));
    group(add_parsed(
              app, "--facing", facing, +[](const std::string& text) { return std::optional(V3f(parse_vector(text))); },
              "The way that --surface faces, where an object has several")
              ->type_name("X,Y,Z"));
    group(add_each(app, "--point", points, parse_vector, "A point [m]")->type_name("X,Y,Z"));
    group(add_each(app, "--line", lines, parse_line, "Points from one end to the other [m]; 11 unless COUNT is given")
              ->type_name("X,Y,Z:X,Y,Z[:COUNT]"));
    grid.add_to(app);
}

void MeasuringPlaces::check(Least least) const {
    const bool has_areas = !tops.empty() || !planes.empty() || !surfaces.empty();
    if (least == Least::one && !has_areas && points.empty() && lines.empty())
        throw UsageError("no places to measure: expected --grid, --plane, --surface, --point or --line");
    if (!over.empty() && planes.empty()) throw UsageError("--over has no effect without --plane");
    if (facing && surfaces.empty()) throw UsageError("--facing has no effect without --surface");
    if (facing && !(facing->length() > 0)) throw UsageError("--facing 0,0,0 is no direction");
    if (least == Least::one && !has_areas && grid.any())
        throw UsageError("--spacing and --boundary have no effect without --grid, --plane or --surface");
}

std::vector<MeasuringGrid> MeasuringPlaces::grids(const Scene& scene) const {
    std::vector<MeasuringGrid> grids;
    GridOptions of_objects = grid.options();
    if (whole_objects) of_objects.boundary = 0;
    for (const std::string& name : tops) grids.push_back(area_grid(scene, find_top(scene, name), of_objects));
    for (const double height : planes) {
        const PlanarArea floor = over.empty() ? find_floor(scene, height) : find_top(scene, over);
        grids.push_back(area_grid(scene, floor, grid.options(), height));
        grids.back().name = fmt::format("{}{}z = {:.4g} m", over, over.empty() ? "" : ", ", height);
    }
    for (const std::string& name : surfaces)
        grids.push_back(area_grid(scene, find_surface(scene, name, facing), of_objects));
    if (!points.empty()) {
        grids.emplace_back();
        grids.back().name = "points";
        grids.back().points = points;
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
        grids.push_back(line_grid(lines[i].a, lines[i].b, lines[i].count));
        if (lines.size() > 1) grids.back().name += fmt::format(" {}", i + 1);
    }
    return grids;
}

std::vector<MeasuringGrid> open_grids(const Scene& scene, const RayCaster& ray_caster,
                                      std::vector<MeasuringGrid> grids) {
    for (MeasuringGrid& grid : grids) grid = without_enclosed_points(scene, ray_caster, std::move(grid));
    return grids;
}

std::string text_of(const MeasuringGrid& grid) {
    std::string text = fmt::format("{} point{}", grid.points.size(), grid.points.size() == 1 ? "" : "s");
    if (grid.columns > 0)
        text += fmt::format(", {} x {}, {:.3g} x {:.3g} m apart", grid.columns, grid.rows, grid.column_spacing,
                            grid.row_spacing);
    else if (grid.column_spacing > 0)
        text += fmt::format(", {:.3g} m apart", grid.column_spacing);
    if (grid.enclosed > 0) text += fmt::format(", without {} inside furniture", grid.enclosed);
    return text;
}

}  // namespace interflect::command
