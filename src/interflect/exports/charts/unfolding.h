#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/exports/mesh/flat_patches.h"
#include "interflect/geometry/surfaces/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// For each patch, the patches that must be in other charts.
using ChartConflicts = std::vector<std::vector<PatchIndex>>;

/// Common parts of edges of two patches, including whole edges.
using Joints = std::vector<SmoothSurfaces::Seam>;

/// Unfolds smooth surfaces by joining flat pieces at common edges. Pieces deform by at most max_stretch and max_shear.
/// A piece starts another layout if it would deform more, overlap, or come closer than `gap` [m] to a piece that is
/// farther away in space.
std::vector<FlatPatches> unfolded(const Scene& scene, const SmoothSurfaces::Groups& corners, const Joints& joints,
                                  const ChartConflicts& conflicts, std::vector<FlatPatches> pieces, double gap);

}  // namespace interflect::detail
