#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Coordinates of a vertex in textures and in its object's lightmap.
struct VertexCoordinates {
    std::optional<V2f> texture;  ///< As Scene::texture_coordinates. Missing values are stored, and compared, as (0, 0).
    std::optional<V2f> lightmap;  ///< As Scene::lightmap_coordinates. Missing values are stored as NaN.

    friend bool operator==(const VertexCoordinates& a, const VertexCoordinates& b) {
        return a.texture.value_or(V2f(0)) == b.texture.value_or(V2f(0)) && a.lightmap == b.lightmap;
    }
};

VertexCoordinates coordinates_of(const Scene& scene, std::uint32_t vertex);

/// Weighted sum of coordinates. Lightmap coordinates are missing if any vertex lacks them, and are clamped to [0, 1].
/// @param weights  One per vertex; sum 1.
VertexCoordinates interpolated(const Scene& scene, std::span<const std::uint32_t> vertices,
                               std::span<const float> weights);

/// Adds a vertex and returns its index. The first vertex with coordinates of a kind adds that array to the scene.
std::uint32_t add_vertex(Scene& scene, const V3f& position, const VertexCoordinates& coordinates);

}  // namespace interflect::inline detail
