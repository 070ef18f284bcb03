#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/render/lights/light_sources.h"
#include "interflect/render/paths/surface_points.h"
#include "interflect/render/rays/traced_scene.h"

namespace interflect::detail {

/// Weighs the scene's light sources by their visibility from the points: a bright lamp in another room must not take
/// the shadow rays of a dim one in this room. Returns nullopt if an eighth of the unoccluded light arrives.
/// The light of a point remains unbiased, and no source has less than half of its shadow rays.
std::optional<LightSources> seen_sources(const TracedScene& scene, std::span<const SurfacePoint> points,
                                         std::uint64_t seed);

}  // namespace interflect::detail
