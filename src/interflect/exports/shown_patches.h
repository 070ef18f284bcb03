#pragma once

#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Returns which patches a picture of the light needs. Excludes patches fully covered by coincident faces
/// (RayCaster::uncovered_share) and dark sides of faces; a face dark on both sides keeps its first. Dark sides would
/// show through along lit edges, or where a renderer draws both sides. Unless the whole scene is dark, also excludes
/// patches surrounded by dark ones (encased_patches()): with multisampling they show through where other faces touch
/// the same surface.
/// @param irradiance  One value per element, patches first.
std::vector<bool> shown_patches(const Scene& scene, std::span<const Rgb> irradiance);

}  // namespace interflect::inline detail
