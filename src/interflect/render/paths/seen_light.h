#pragma once

#include <span>

#include "interflect/render/lights/known_light.h"
#include "interflect/render/paths/indirect_field.h"

namespace interflect::detail {

struct PathScene;

/// Makes light.sample() suit the points, by rays from random ones: it finds elements that are brighter than twice the
/// mean of what they see, and seldom those of patches that are hidden from them, such as sunlit walls outdoors.
/// @param scene  Only its ray caster, panes, geometry and seed are used.
void sample_seen_light(KnownLight& light, const PathScene& scene, std::span<const SurfacePoint> points);

}  // namespace interflect::detail
