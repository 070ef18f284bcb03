#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Flat surface of each patch, identified by the surface's lowest patch, whose side is the front. Patches belong
/// together if they have the same material and object and share whole edges in (nearly) one plane, or if they have the
/// same Patch::surface. This recovers the surface that a reader has triangulated or a mesher has divided. O(n log n).
std::vector<std::uint32_t> flat_surfaces(const Scene& scene);

/// Ranks patches by the flat surface to which they belong.
/// @return  A unique rank per patch. Surfaces of smaller area come first; among surfaces of (nearly) equal area,
///          emitters come before others, then the lower first patch. Patches of one surface are ordered by index. A
///          two-sided face counts once; its sides have adjacent ranks, front first. O(n log n).
std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene);

}  // namespace interflect::inline detail
