#pragma once

#include <cstdint>
#include <span>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// The share of a patch's area, in [0, 1], that is left outside the polygons of `others`, faces in (nearly) its plane,
/// which may overlap each other in any way.
/// @param tolerance  Width of the slivers along the patch's edges that count as covered, and as uncovered where next to
///                   nothing is covered [m].
/// @return           Exactly 0 or 1 where it differs by such slivers only. About O(k log k) for k others.
float uncovered_area_share(const Scene& scene, std::uint32_t patch, std::span<const std::uint32_t> others,
                           float tolerance);

}  // namespace interflect::inline detail
