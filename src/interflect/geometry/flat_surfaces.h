#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the flat surface of each patch, identified by its lowest patch. Patches of a surface share material, object
/// and whole edges in nearly one plane, or have the same Patch::surface. Reverses triangulation and meshing. O(n log
/// n).
std::vector<std::uint32_t> flat_surfaces(const Scene& scene);

/// Returns a unique rank per patch: by area of the flat surface, at nearly equal areas emitters first, then by lowest
/// patch; within a surface by index. The sides of a face have adjacent ranks, front first, and count as one area. O(n
/// log n).
std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene);

}  // namespace interflect::detail
