#pragma once

#include <span>

#include "interflect/render/lights/known_light.h"
#include "interflect/render/paths/indirect_field.h"

namespace interflect::detail {

struct PathScene;

/// Adapts light.sample() to the points, by rays from random ones: it returns elements brighter than twice the mean
/// radiosity visible from them, and seldom an element of a hidden patch, such as a sunlit wall outdoors.
/// @param scene  Only its ray caster, panes, geometry and seed are used.
void sample_seen_light(KnownLight& light, const PathScene& scene, std::span<const SurfacePoint> points);

}  // namespace interflect::detail
