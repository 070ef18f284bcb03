#pragma once

#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Which patches a picture of the light needs: all but the sides of faces from which no light comes while some comes
/// from the other side, or from neither. Nobody sees the insides of closed bodies, and in renderers that do not tell
/// the sides apart they would cover what is lit.
/// @param irradiance  Of every element, patches first.
std::vector<bool> shown_patches(const Scene& scene, std::span<const Rgb> irradiance);

}  // namespace interflect::inline detail
