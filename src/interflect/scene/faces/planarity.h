#pragma once

#include <array>
#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

/// Largest warp of a planar quadrilateral, relative to its largest coordinate: 16 float steps, more than the rounding
/// of transforms; a quarter of RayCaster::ray_offset().
inline constexpr double relative_planarity = 0x1p-19;

/// Returns the distance of a convex quadrilateral's corners from their mean plane [m]. It is the maximum distance
/// between the bilinear surface (ray origins) and the two triangles (hits).
double warp(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

/// Whether a convex quadrilateral may be one patch.
bool is_planar(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

}  // namespace interflect::detail
