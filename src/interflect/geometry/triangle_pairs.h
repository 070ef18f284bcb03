#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Vertices of a face, counter-clockwise; the fourth is none for a triangle.
using FaceVertices = std::array<std::uint32_t, 4>;

/// Merges pairs of triangles that form a planar, convex quadrilateral with linear texture and lightmap coordinates.
/// Exporters split quadrilaterals, and two triangles cost twice as much as one patch. Pairs along the longest edge of
/// both triangles come first, since it is the diagonal of a rectangle.
/// @param scene      Contains the vertices, welded: triangles that share an edge share its vertices.
/// @param triangles  Corners, three per triangle; indices into the scene's vertices.
/// @return           Every triangle once, alone or merged, in the order of the first of each pair. O(n log n).
std::vector<FaceVertices> merge_triangle_pairs(const Scene& scene, std::span<const std::uint32_t> triangles);

}  // namespace interflect::detail
