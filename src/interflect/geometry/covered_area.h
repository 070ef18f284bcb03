#pragma once

#include <cstdint>
#include <span>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the fraction of a patch's area in [0, 1] outside the nearly coplanar faces `others`, which may overlap.
/// About O(k log k) for k others.
/// @param tolerance  Width of slivers along the patch's edges [m]. The result is exactly 0 (1) if at
///                   most slivers are uncovered (covered).
float uncovered_area_share(const Scene& scene, std::uint32_t patch, std::span<const std::uint32_t> others,
                           float tolerance);

}  // namespace interflect::detail
