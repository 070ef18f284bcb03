#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Vertices of a face, counter-clockwise. The fourth is `none` for a triangle.
using FaceVertices = std::array<std::uint32_t, 4>;

/// Edge of a triangle from `corner` to the next one.
struct TriangleEdge {
    std::uint64_t vertices = 0;  ///< Both vertex indices in one number, the lower one in the upper bits.
    std::uint32_t triangle = 0;
    std::uint32_t corner = 0;
};

/// Number of triangles considered at one edge. More triangles meet only in meshes that are not surfaces.
inline constexpr std::size_t max_triangles_at_edge = 8;

/// Calls use(a, b), in order, for each pair of edges between the same vertices. Pairs more than
/// max_triangles_at_edge - 1 places apart are omitted.
/// @param edges  The edges, sorted by `vertices`.
template <class Use>
void for_pairs_at_edges(std::span<const TriangleEdge> edges, const Use& use) {
    for (std::size_t a = 0; a < edges.size(); ++a)
        for (std::size_t b = a + 1; b < std::min(edges.size(), a + max_triangles_at_edge); ++b) {
            if (edges[b].vertices != edges[a].vertices) break;
            use(edges[a], edges[b]);
        }
}

/// Merges triangles into planar, convex quadrilaterals with linear texture and lightmap coordinates. Prefers pairs
/// along the longest edge of both. Faces keep the order of their first triangles. Cost: O(triangles log(triangles)).
/// @param scene      Its vertices must be welded.
/// @param triangles  Three vertex indices each.
std::vector<FaceVertices> merge_triangle_pairs(const Scene& scene, std::span<const std::uint32_t> triangles);

}  // namespace interflect::detail
