#pragma once

#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Finds dark patches inside solids. Few of their rays reach light or escape, and most of their rays are short.
std::vector<bool> encased_patches(const Scene& scene, const RayCaster& ray_caster, const std::vector<bool>& is_dark);

}  // namespace interflect::detail
