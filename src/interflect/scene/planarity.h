#pragma once

#include <array>
#include <cstdint>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Largest warp of a planar quadrilateral, relative to its largest coordinate: 16 steps of a float. This exceeds the
/// rounding of a transform and is a quarter of the ray offset (RayCaster::ray_offset).
inline constexpr double relative_planarity = 0x1p-19;

/// Distance of the corners of a convex quadrilateral from their mean plane [m]. It is also the largest distance between
/// the bilinear surface, where rays start, and the two triangles, which rays hit.
double warp(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

/// Whether a convex quadrilateral may be one patch. With more warp it must become two triangles: rays that start on its
/// bilinear surface would pass through its triangles.
bool is_planar(const Scene& scene, const std::array<std::uint32_t, 4>& vertices);

}  // namespace interflect::inline detail
