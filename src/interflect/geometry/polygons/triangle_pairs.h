#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Counter-clockwise; the fourth is none for a triangle.
using FaceVertices = std::array<std::uint32_t, 4>;

/// Edge of a triangle, from this corner to the next.
struct TriangleEdge {
    std::uint64_t vertices = 0;  ///< Equal for edges between the same vertices.
    std::uint32_t triangle = 0;
    std::uint32_t corner = 0;
};

/// More triangles meet only at edges of meshes that are no surfaces.
inline constexpr std::size_t max_triangles_at_edge = 8;

/// Calls use(a, b) for edges between the same vertices, in order; `b` is at most max_triangles_at_edge - 1 after `a`.
/// @param edges  Sorted by vertices.
template <class Use>
void for_pairs_at_edges(std::span<const TriangleEdge> edges, const Use& use) {
    for (std::size_t a = 0; a < edges.size(); ++a)
        for (std::size_t b = a + 1; b < std::min(edges.size(), a + max_triangles_at_edge); ++b) {
            if (edges[b].vertices != edges[a].vertices) break;
            use(edges[a], edges[b]);
        }
}

/// Merges triangles into planar, convex quadrilaterals with linear texture and lightmap coordinates. Prefers pairs
/// along the longest edge of both. Keeps the order of first triangles. Cost: O(triangles log(triangles)).
/// @param scene      With welded vertices.
/// @param triangles  Three vertex indices each.
std::vector<FaceVertices> merge_triangle_pairs(const Scene& scene, std::span<const std::uint32_t> triangles);

}  // namespace interflect::detail
