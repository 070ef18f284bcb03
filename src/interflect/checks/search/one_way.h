#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Whether a ray passes the back of a one-sided face, which blocks the reversed ray. @param hit  First hit.
bool is_one_way(const Scene& scene, const RayCaster& ray_caster, const Ray& ray, const Hit& hit);

}  // namespace interflect::detail
