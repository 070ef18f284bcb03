#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Whether light does not return along a ray: the ray has passed the back of a one-sided face, which blocks the
/// reversed ray.
/// @param hit  First hit of the ray.
bool is_one_way(const Scene& scene, const RayCaster& ray_caster, const Ray& ray, const Hit& hit);

}  // namespace interflect::detail
