#include "interflect/exports/authored/vertex_splits.h"

#include <map>
#include <utility>

namespace interflect::detail {

namespace {

using Place = SplitVertices::Place;

Imath::V2d texel_at(const AuthoredShape& shape, const Place& place) {
    const LightmapChart& chart = shape.charts[place.chart];
    return chart.patches[place.patch].corners[place.corner] / chart.spacing();
}

bool are_equal(const AuthoredShape& shape, const Place& a, const Place& b) {
    constexpr double rounding = 1e-3;  // [texels]
    return a.chart == b.chart && (texel_at(shape, a) - texel_at(shape, b)).length() < rounding;
}

/// Returns the place of the first corner of each triangle with an area. Keys: mesh, index of the corner.
std::map<std::pair<std::uint32_t, std::uint32_t>, Place> places_of_triangles(const AuthoredShape& shape) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Place> places;
    for (std::uint32_t c = 0; c < shape.charts.size(); ++c)
        for (std::uint32_t k = 0; k < shape.charts[c].patches.size(); ++k) {
            const auto& [mesh, first] = shape.triangles[shape.charts[c].patches[k].patch];
            places[{mesh, first}] = {c, k, 0};
        }
    return places;
}

}  // namespace

SplitVertices split_vertices(const Model& model, const AuthoredShape& shape, std::uint32_t primitive,
                             std::uint32_t vertex_count) {
    const auto triangles = places_of_triangles(shape);
    SplitVertices result;
    result.places.resize(vertex_count);
    std::vector<std::vector<std::uint32_t>> copies(vertex_count);  // copies of each vertex
    const auto vertex_at = [&](std::uint32_t vertex, const Place& place) {
        if (place.chart == none) return vertex;
        if (result.places[vertex].chart == none) result.places[vertex] = place;
        if (are_equal(shape, result.places[vertex], place)) return vertex;
        for (const std::uint32_t copy : copies[vertex])
            if (are_equal(shape, result.places[copy], place)) return copy;
        const auto copy = static_cast<std::uint32_t>(result.places.size());
        result.places.push_back(place);
        result.copied.push_back(vertex);
        copies[vertex].push_back(copy);
        return copy;
    };
    for (const std::uint32_t index : shape.meshes) {
        const Mesh& mesh = model.meshes[index];
        if (mesh.source.primitive != primitive) continue;
        for (std::uint32_t first = 0; first < mesh.indices.size(); first += 3) {
            const auto found = triangles.find({index, first});
            Place place = found == triangles.end() ? Place{} : found->second;
            for (std::uint32_t c = 0; c < 3; ++c) {
                place.corner = c;
                result.corners.push_back(vertex_at(mesh.source.vertices[mesh.indices[first + c]], place));
            }
        }
    }
    return result;
}

}  // namespace interflect::detail
