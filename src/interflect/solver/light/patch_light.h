#pragma once

#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the largest channel of exitance + irradiance, M + H, of each patch.
/// @param irradiance  One value per element; patches come first.
std::vector<float> patch_light(const Scene& scene, std::span<const Rgb> irradiance);

}  // namespace interflect::detail
