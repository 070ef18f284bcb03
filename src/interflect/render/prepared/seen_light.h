#pragma once

#include <cstdint>
#include <span>

#include "interflect/render/paths/surface_points.h"
#include "interflect/render/rays/traced_scene.h"
#include "interflect/render/reflections/known_light.h"

namespace interflect::detail {

/// Adapts light.sample() to the points by tracing rays from random points. Afterwards it samples only elements brighter
/// than twice the mean radiosity visible from the points, and rarely an element of a hidden patch, such as a sunlit
/// wall outdoors.
void sample_seen_light(KnownLight& light, const TracedScene& scene, std::span<const SurfacePoint> points,
                       std::uint64_t seed);

}  // namespace interflect::detail
