#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// The flat surface that each patch is part of, named by its lowest patch, whose side is the front: patches of one
/// material and object that are joined by whole edges in (nearly) one plane, or have one Patch::surface, so that what a
/// reader has triangulated or a mesh divided counts as the one thing it was. O(n log n).
std::vector<std::uint32_t> flat_surfaces(const Scene& scene);

/// Ranks patches by the flat surface that they are part of.
/// @return  The rank of each patch, all different: first those of the surface of least area; of surfaces of (nearly)
///          equal area those that emit before those that do not, then by their first patch; patches of one surface by
///          index. A two-sided face counts once, and its sides are neighbours in rank, the front first. O(n log n).
std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene);

}  // namespace interflect::inline detail
