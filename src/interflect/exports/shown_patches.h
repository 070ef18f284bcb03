#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::detail {

/// Returns which patches a picture of the light needs. Excludes patches fully covered by coincident faces
/// (RayCaster::uncovered_share) and dark sides of faces; a face dark on both sides keeps its first. Dark sides would
/// show through along lit edges, or where a renderer draws both sides. Unless the whole scene is dark, also excludes
/// patches surrounded by dark ones (encased_patches()): with multisampling they show through where other faces touch
/// the same surface.
///
/// Sides are dark at 0.001 lx, or at 1e-4 of the mean where that is less, since light need not be in photometric units;
/// patches inside solids at 1e-3 of the mean. Light before dim() counts, so all states of a solution show the same
/// patches.
std::vector<bool> shown_patches(const Scene& scene, const Solution& solution);

}  // namespace interflect::detail
