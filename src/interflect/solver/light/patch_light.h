#pragma once

#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Largest channel of M + H of each patch. @param irradiance  By element.
std::vector<float> patch_light(const Scene& scene, std::span<const Rgb> irradiance);

}  // namespace interflect::detail
