#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/exports/flat_patches.h"
#include "interflect/render/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Of each patch those that must be in other charts.
using ChartConflicts = std::vector<std::vector<std::uint32_t>>;

/// Edges, or parts of them, across which two patches of a smooth surface continue each other.
using Joints = std::vector<SmoothSurfaces::Seam>;

/// Unfolds smooth surfaces into the plane: joins flat pieces along their common edges, as if on hinges. Exact for
/// developable surfaces, such as cylinders and cones. Elsewhere, as on spheres, a piece gives way so that it shares its
/// corners with the pieces around it: each edge keeps its length to a tenth, each corner its area to a fifth. Where a
/// loop closes only with more, or where pieces would overlap, the piece begins another layout. So does one that would
/// come closer than `gap` [m] to a piece that is further from it in space.
/// @param corners  Of find_smooth_surfaces().
/// @param joints   Between pieces. @param conflicts  Between patches.
/// Cost: O(n) for n pieces of bounded layouts (most_patches_unfolded).
std::vector<FlatPatches> unfolded(const Scene& scene, const SmoothSurfaces::Groups& corners, const Joints& joints,
                                  const ChartConflicts& conflicts, std::vector<FlatPatches> pieces, double gap);

}  // namespace interflect::inline detail
