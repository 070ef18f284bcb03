#pragma once

#include <cstdint>
#include <span>

#include "interflect/scene.h"

namespace interflect::detail {

/// Fraction of a patch's area, in [0, 1], outside the (nearly) coplanar faces `others`, which may overlap.
/// @param tolerance  Width of slivers along the patch's edges [m]. They count as covered, or as uncovered if nothing
///                   next to them is covered.
/// @return           Exactly 0 or 1 if only such slivers make the difference. About O(k log k) for k others.
float uncovered_area_share(const Scene& scene, std::uint32_t patch, std::span<const std::uint32_t> others,
                           float tolerance);

}  // namespace interflect::detail
