#include "interflect/geometry/polygons/vertex_coordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace interflect::detail {

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

std::optional<V2f> within_lightmap(const V2f& coordinate) {
    if (std::isnan(coordinate.x) || std::isnan(coordinate.y)) return std::nullopt;
    return V2f(std::clamp(coordinate.x, 0.0f, 1.0f), std::clamp(coordinate.y, 0.0f, 1.0f));
}

V3f interpolated_normal(const std::vector<V3f>& normals, std::span<const std::uint32_t> vertices,
                        std::span<const float> weights) {
    if (vertices.size() == 1) return normals[vertices[0]];
    V3f sum(0);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (normals[vertices[i]] == V3f(0)) return V3f(0);
        sum += normals[vertices[i]] * weights[i];
    }
    return sum.normalized();
}

}  // namespace

VertexCoordinates coordinates_of(const Scene& scene, std::uint32_t vertex) {
    constexpr float whole = 1;
    return interpolated(scene, {&vertex, 1}, {&whole, 1});
}

VertexCoordinates interpolated(const Scene& scene, std::span<const std::uint32_t> vertices,
                               std::span<const float> weights) {
    const auto sum = [&](const std::vector<V2f>& coordinates) {
        V2f result(0);
        for (std::size_t i = 0; i < vertices.size(); ++i) result += coordinates[vertices[i]] * weights[i];
        return result;
    };
    VertexCoordinates result;
    if (!scene.texture_coordinates.empty()) result.texture = sum(scene.texture_coordinates);
    if (!scene.lightmap_coordinates.empty()) result.lightmap = within_lightmap(sum(scene.lightmap_coordinates));
    if (!scene.normals.empty()) result.normal = interpolated_normal(scene.normals, vertices, weights);
    return result;
}

V3f welded_normal(const Imath::V3d& normal) {
    constexpr double steps = 256;  // a step turns the normal by 0.2 degrees, far less than a visible crease
    const Imath::V3d n = normal.normalized() * steps;
    if (!std::isfinite(n.x + n.y + n.z) || n == Imath::V3d(0)) return V3f(0);
    return V3f(Imath::V3d(std::round(n.x), std::round(n.y), std::round(n.z)).normalized());
}

std::uint32_t add_vertex(Scene& scene, const V3f& position, const VertexCoordinates& coordinates) {
    const auto add = [&](std::vector<V2f>& all, const std::optional<V2f>& coordinate, const V2f& missing) {
        if (!coordinate && all.empty()) return;
        all.resize(scene.vertices.size(), missing);
        all.push_back(coordinate.value_or(missing));
    };
    add(scene.texture_coordinates, coordinates.texture, V2f(0));
    add(scene.lightmap_coordinates, coordinates.lightmap, V2f(not_a_number));
    if (coordinates.normal != V3f(0) || !scene.normals.empty()) {
        scene.normals.resize(scene.vertices.size(), V3f(0));
        scene.normals.push_back(coordinates.normal);
    }
    scene.vertices.push_back(position);
    return static_cast<std::uint32_t>(scene.vertices.size() - 1);
}

}  // namespace interflect::detail
