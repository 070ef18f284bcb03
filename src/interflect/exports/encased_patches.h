#pragma once

#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Finds dark patches inside solids, such as the part of a wall behind a door frame. Cameras in lit places cannot see
/// them. The walls of dark rooms are not included. Patches that are dark only because no ray of the solution hit them
/// are not included either: some of their own rays reach light.
/// @param is_dark  Of each patch: it neither emits nor receives light.
/// @return         Of each patch, whether it is dark, at most 2 of 64 sample rays reach light or leave the scene, and
///                 most of them end within half a metre.
/// Cost: 128 rays for each dark patch.
std::vector<bool> encased_patches(const Scene& scene, const RayCaster& ray_caster, const std::vector<bool>& is_dark);

}  // namespace interflect::inline detail
