#include "interflect/exports/files/vtk_grid.h"

#include <fmt/format.h>

#include "interflect/elements/forest.h"
#include "interflect/solver/light/materials.h"

namespace interflect::detail {

namespace {

template <class Value>
VtkArray vtk_array(std::string name, std::size_t count, const Value& value) {
    using Result = std::remove_cvref_t<decltype(value(std::size_t{0}))>;
    if constexpr (std::is_arithmetic_v<Result>) {
        std::vector<Result> numbers(count);
        for (std::size_t i = 0; i < count; ++i) numbers[i] = value(i);
        return {std::move(name), 1, std::move(numbers)};
    } else {
        std::vector<typename Result::BaseType> numbers;
        numbers.reserve(3 * count);
        for (std::size_t i = 0; i < count; ++i) {
            const Result vector = value(i);
            numbers.insert(numbers.end(), {vector.x, vector.y, vector.z});
        }
        return {std::move(name), 3, std::move(numbers)};
    }
}

}  // namespace

VtkArray VtkGrid::points() const {
    const auto point = [&](std::size_t i) { return polygons_.points[polygons_.vertices[i].point]; };
    if (scene_.origin == Imath::V3d(0)) return vtk_array("Points", point_count(), point);
    return vtk_array("Points", point_count(), [&](std::size_t i) { return scene_.origin + Imath::V3d(point(i)); });
}

std::vector<std::int64_t> VtkGrid::connectivity() const { return {polygons_.corners.begin(), polygons_.corners.end()}; }

std::vector<std::int64_t> VtkGrid::offsets() const {
    std::vector<std::int64_t> offsets{0};
    offsets.insert(offsets.end(), polygons_.ends.begin(), polygons_.ends.end());
    return offsets;
}

std::vector<std::uint8_t> VtkGrid::types() const {
    constexpr std::uint8_t triangle = 5, polygon = 7;
    std::vector<std::uint8_t> types(cell_count());
    for (std::size_t i = 0; i < types.size(); ++i)
        types[i] = polygons_.ends[i] - polygons_.begin(i) == 3 ? triangle : polygon;
    return types;
}

void VtkGrid::visit_point_data(const Sink& sink) const {
    const auto add = [&](const char* name, const auto& of_vertex) {
        sink(vtk_array(name, point_count(), [&](std::size_t i) { return of_vertex(polygons_.vertices[i]); }));
    };
    add("illuminance", [](const LitPolygons::Vertex& vertex) { return luminance(vertex.irradiance); });
    add("irradiance", [](const LitPolygons::Vertex& vertex) { return vertex.irradiance; });
    add("radiosity", [](const LitPolygons::Vertex& vertex) { return vertex.radiosity; });
}

void VtkGrid::visit_cell_data(const Sink& sink) const {
    const ElementForest& forest = *solution_.forest;
    Materials materials(scene_);
    materials.grow(forest);
    const std::vector<Rgb> leaving = radiosity(materials, forest, solution_.irradiance);
    const auto add = [&](std::string name, const auto& of_element) {
        sink(vtk_array(std::move(name), cell_count(), [&](std::size_t i) { return of_element(polygons_.leaves[i]); }));
    };
    const auto add_numbers = [&](const char* name, const std::vector<float>& numbers) {
        if (!numbers.empty()) add(name, [&](ElementIndex e) { return numbers[e]; });
    };
    add("illuminance", [&](ElementIndex e) { return luminance(solution_.irradiance[e]); });
    add("irradiance", [&](ElementIndex e) { return solution_.irradiance[e]; });
    if (!solution_.direct.empty())
        add("direct_irradiance", [&](ElementIndex e) {
            Rgb sum(0);
            for (const std::vector<Rgb>& part : solution_.direct) sum += part[e];
            return sum;
        });
    for (std::size_t g = 0; g < solution_.groups.size(); ++g)
        add(fmt::format("irradiance_of_group_{}", g), [&](ElementIndex e) { return solution_.groups[g][e]; });
    add("radiosity", [&](ElementIndex e) { return leaving[e]; });
    add_numbers("standard_error", solution_.standard_error);
    add_numbers("discretisation_error", solution_.discretisation_error);
    add_numbers("rays", solution_.rays);
    add_numbers("view_importance", solution_.view_importance);
    add_numbers("indirect_importance", solution_.indirect_importance);
    add("element", [](ElementIndex e) { return e.value; });
    add("patch", [&](ElementIndex e) { return forest.patch(e).value; });
    add("level", [&](ElementIndex e) { return static_cast<std::uint8_t>(forest.level(e)); });
    add("material", [&](ElementIndex e) { return scene_.patches[forest.patch(e)].material; });
    add("object", [&](ElementIndex e) { return scene_.patches[forest.patch(e)].object; });
}

}  // namespace interflect::detail
