#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/scene.h"

namespace interflect::detail {

struct VertexCoordinates {
    std::optional<V2f> texture;   ///< Stored and compared as (0, 0) if missing.
    std::optional<V2f> lightmap;  ///< Stored as NaN if missing.
    V3f normal{0, 0, 0};          ///< Zero if missing.

    friend bool operator==(const VertexCoordinates& a, const VertexCoordinates& b) {
        return a.texture.value_or(V2f(0)) == b.texture.value_or(V2f(0)) && a.lightmap == b.lightmap &&
               a.normal == b.normal;
    }
};

VertexCoordinates coordinates_of(const Scene& scene, std::uint32_t vertex);

/// Interpolates between vertices. The lightmap coordinate or the normal is missing if any vertex lacks it.
/// @param weights  Weight of each vertex; their sum is 1.
VertexCoordinates interpolated(const Scene& scene, std::span<const std::uint32_t> vertices,
                               std::span<const float> weights);

/// Normalises and rounds a normal, which makes nearly equal normals equal. Returns zero for zero and non-finite
/// vectors.
V3f welded_normal(const Imath::V3d& normal);

/// Returns the index of the new vertex. Once a vertex has an attribute, all vertices store it.
std::uint32_t add_vertex(Scene& scene, const V3f& position, const VertexCoordinates& coordinates);

}  // namespace interflect::detail
