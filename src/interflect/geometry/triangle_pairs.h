#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Counter-clockwise; the fourth is none for a triangle.
using FaceVertices = std::array<std::uint32_t, 4>;

/// Merges triangles into planar, convex quadrilaterals with linear texture and lightmap coordinates. Prefers pairs
/// along the longest edge of both. Keeps the order of first triangles.
/// @param scene      With welded vertices.
/// @param triangles  Three vertex indices each.
std::vector<FaceVertices> merge_triangle_pairs(const Scene& scene, std::span<const std::uint32_t> triangles);

}  // namespace interflect::detail
