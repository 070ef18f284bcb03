#pragma once

#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Finds dark patches inside solids, such as a wall behind a door frame. Few of their rays reach light or leave the
/// scene, and most are short. Cost: 128 rays per dark patch.
std::vector<bool> encased_patches(const Scene& scene, const RayCaster& ray_caster, const std::vector<bool>& is_dark);

}  // namespace interflect::detail
