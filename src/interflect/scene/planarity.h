#pragma once

#include <array>
#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

/// Largest warp of a planar quadrilateral, relative to its largest coordinate: 16 float steps. Exceeds the rounding of
/// transforms; equals a quarter of RayCaster::ray_offset().
inline constexpr double relative_planarity = 0x1p-19;

/// Returns the distance of the corners of a convex quadrilateral from their mean plane [m]. Also the largest distance
/// between its bilinear surface, where rays start, and its two triangles, which rays hit.
double warp(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

/// Whether a convex quadrilateral may be one patch. If not, rays from its bilinear surface would pass its triangles.
bool is_planar(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

}  // namespace interflect::detail
