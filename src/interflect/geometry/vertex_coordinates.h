#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Where a vertex lies in its material's images and in its object's lightmap.
struct VertexCoordinates {
    std::optional<V2f> texture;   ///< As Scene::texture_coordinates; missing ones are kept, and compared, as (0, 0).
    std::optional<V2f> lightmap;  ///< As Scene::lightmap_coordinates; missing ones are kept as NaN.

    friend bool operator==(const VertexCoordinates& a, const VertexCoordinates& b) {
        return a.texture.value_or(V2f(0)) == b.texture.value_or(V2f(0)) && a.lightmap == b.lightmap;
    }
};

/// Those of a vertex of `scene`.
VertexCoordinates coordinates_of(const Scene& scene, std::uint32_t vertex);

/// The weighted sum of those of some vertices. Lightmap coordinates are missing where one of the vertices has none, and
/// are clamped to [0, 1], which rounding may leave. @param weights  One for each vertex; sum 1.
VertexCoordinates interpolated(const Scene& scene, std::span<const std::uint32_t> vertices,
                               std::span<const float> weights);

/// Adds a vertex and returns its index. The scene has each kind of coordinates from the first vertex on that has some.
std::uint32_t add_vertex(Scene& scene, const V3f& position, const VertexCoordinates& coordinates);

}  // namespace interflect::inline detail
