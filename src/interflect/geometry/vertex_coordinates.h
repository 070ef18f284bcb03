#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/scene.h"

namespace interflect::detail {

/// Attributes of a vertex beside its position.
struct VertexCoordinates {
    std::optional<V2f> texture;  ///< As Scene::texture_coordinates. Missing values are stored, and compared, as (0, 0).
    std::optional<V2f> lightmap;  ///< As Scene::lightmap_coordinates. Missing values are stored as NaN.
    V3f normal{0, 0, 0};          ///< As Scene::normals.

    friend bool operator==(const VertexCoordinates& a, const VertexCoordinates& b) {
        return a.texture.value_or(V2f(0)) == b.texture.value_or(V2f(0)) && a.lightmap == b.lightmap &&
               a.normal == b.normal;
    }
};

VertexCoordinates coordinates_of(const Scene& scene, std::uint32_t vertex);

/// Interpolates the attributes of some vertices. Lightmap coordinates are missing if one of the vertices has none, and
/// are clamped to [0, 1] against rounding. The normal is zero if one of the vertices has none.
/// @param weights  One for each vertex; sum 1.
VertexCoordinates interpolated(const Scene& scene, std::span<const std::uint32_t> vertices,
                               std::span<const float> weights);

/// Normalises a normal of a file and rounds it, so that vertices with nearly equal normals are welded: faces of one
/// plane then share vertices whatever the rounding in the file. Zero for a vector that is zero or not finite.
V3f welded_normal(const Imath::V3d& normal);

/// Adds a vertex and returns its index. The scene has each kind of coordinates from the first vertex on that has some.
std::uint32_t add_vertex(Scene& scene, const V3f& position, const VertexCoordinates& coordinates);

}  // namespace interflect::detail
