#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Counter-clockwise; the fourth is none for a triangle.
using FaceVertices = std::array<std::uint32_t, 4>;

/// Merges pairs of triangles into planar, convex quadrilaterals with linear texture and lightmap coordinates, which
/// halves the number of patches. Pairs along the longest edge of both, a rectangle's diagonal, come first.
/// @param scene      Contains the vertices, welded.
/// @param triangles  Three vertex indices per triangle.
/// @return           Faces in the order of their first triangle. O(n log n).
std::vector<FaceVertices> merge_triangle_pairs(const Scene& scene, std::span<const std::uint32_t> triangles);

}  // namespace interflect::detail
