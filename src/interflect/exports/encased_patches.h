#pragma once

#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Finds dark patches inside solids, such as a wall behind a door frame, which cameras in lit places cannot see.
/// Excludes walls of dark rooms, and patches that are dark only because the solution's rays missed them.
/// @param is_dark  Whether each patch has no light, or too little to be seen.
/// @return         Whether each patch is dark, at most 2 of its 64 rays reach light or leave the scene, and most rays
///                 end within half a metre. Cost: 128 rays per dark patch.
std::vector<bool> encased_patches(const Scene& scene, const RayCaster& ray_caster, const std::vector<bool>& is_dark);

}  // namespace interflect::detail
