#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Flat surface of each patch, identified by the surface's lowest patch, whose side is the front. Patches belong
/// together if they share material, object and whole edges in (nearly) one plane, or have the same Patch::surface. This
/// undoes triangulation by readers and division by meshers. O(n log n).
std::vector<std::uint32_t> flat_surfaces(const Scene& scene);

/// Ranks patches by their flat surface.
/// @return  A unique rank per patch. Order: area of the surface; at (nearly) equal areas, emitters first, then the
///          lowest patch. Within a surface: patch index. The sides of a two-sided face have adjacent ranks, front
///          first; its area counts once. O(n log n).
std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene);

}  // namespace interflect::detail
