#pragma once

#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Which patches a picture of the light needs: all but those that coincident faces cover wholly
/// (RayCaster::uncovered_share), and but the dark sides of faces, of which one dark on both sides keeps its first. They
/// would show through along the edges of what is lit, and in its place where a renderer draws both sides of a face.
/// @param irradiance  Of every element, patches first.
std::vector<bool> shown_patches(const Scene& scene, std::span<const Rgb> irradiance);

}  // namespace interflect::inline detail
