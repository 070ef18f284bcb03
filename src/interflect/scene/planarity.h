#pragma once

#include <array>
#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

/// Largest warp of a planar quadrilateral, relative to its largest coordinate: 16 steps of a float. Exceeds the
/// rounding of a transform; a quarter of the ray offset (RayCaster::ray_offset).
inline constexpr double relative_planarity = 0x1p-19;

/// Distance of a convex quadrilateral's corners from their mean plane [m]. Also the largest distance between the
/// bilinear surface, where rays start, and the two triangles, which rays hit.
double warp(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

/// Whether a convex quadrilateral may be one patch. Otherwise rays from its bilinear surface would pass through its two
/// triangles.
bool is_planar(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

}  // namespace interflect::detail
