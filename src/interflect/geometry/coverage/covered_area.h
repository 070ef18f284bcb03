#pragma once

#include <cstdint>
#include <span>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the share of a patch's area, from 0 to 1, that nearly coplanar faces leave uncovered.
/// @param tolerance  Width of slivers along the edges [m]. If only slivers are uncovered (covered), returns 0 (1).
float uncovered_area_share(const Scene& scene, PatchIndex patch, std::span<const std::uint32_t> others,
                           float tolerance);

}  // namespace interflect::detail
