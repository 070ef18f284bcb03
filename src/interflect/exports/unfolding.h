#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/exports/flat_patches.h"
#include "interflect/render/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// For each patch, the patches that must be in other charts.
using ChartConflicts = std::vector<std::vector<std::uint32_t>>;

/// Edges, or parts of them, that join two patches of a smooth surface.
using Joints = std::vector<SmoothSurfaces::Seam>;

/// Unfolds smooth surfaces into the plane by joining flat pieces at common edges. Exact for developable surfaces, such
/// as cylinders and cones. On others, such as spheres, pieces deform to share corners: edges by up to 10%, areas at
/// corners by up to 20%. A piece that would deform more, overlap, or come closer than `gap` [m] to a piece further away
/// in space starts another layout.
/// @param corners  From find_smooth_surfaces().
/// @param joints   Between pieces. @param conflicts  Between patches.
/// Cost: O(n) for n pieces of bounded layouts (most_patches_unfolded).
std::vector<FlatPatches> unfolded(const Scene& scene, const SmoothSurfaces::Groups& corners, const Joints& joints,
                                  const ChartConflicts& conflicts, std::vector<FlatPatches> pieces, double gap);

}  // namespace interflect::detail
