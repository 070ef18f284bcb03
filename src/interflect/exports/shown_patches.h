#pragma once

#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Returns which patches a picture of the light needs. Excludes patches that coincident faces cover completely
/// (RayCaster::uncovered_share) and the dark sides of faces; a face dark on both sides keeps its first. Dark sides
/// would show through along lit edges, or instead of lit sides in renderers that draw both sides. Also excludes patches
/// that only dark ones surround (encased_patches()), unless the whole scene is dark. With multisampling they show
/// through along the edges where faces in front of them touch the same surface.
/// @param irradiance  One value per element, patches first.
std::vector<bool> shown_patches(const Scene& scene, std::span<const Rgb> irradiance);

}  // namespace interflect::inline detail
