#pragma once

#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Which patches a picture of the light needs: all but those that coincident faces cover wholly
/// (RayCaster::uncovered_share), and but the dark sides of faces, of which one dark on both sides keeps its first. They
/// would show through along the edges of what is lit, and in its place where a renderer draws both sides of a face.
/// Patches that only dark ones surround (encased_patches()) are left out too, unless the whole scene is dark: with
/// multisampling they show through along the edges where the faces before them touch the same surface.
/// @param irradiance  Of every element, patches first.
std::vector<bool> shown_patches(const Scene& scene, std::span<const Rgb> irradiance);

}  // namespace interflect::inline detail
