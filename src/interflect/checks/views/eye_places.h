#pragma once

#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Returns at most 128 points from which a camera might show the scene, relative to its origin [m]. They are at eye
/// height above faces: below the points of a grid over core_bounds(), and above random points of faces that face
/// upwards, half of them by area and half by number of patches. Points under a roof have priority, since a small
/// building may stand on a large ground. Some places lie in solids or outside of rooms. Traces at most 576 rays.
/// @param up  Unit vector along an axis.
std::vector<V3f> eye_places(const Scene& scene, const RayCaster& ray_caster, const V3f& up);

}  // namespace interflect::detail
