#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/render/lights/light_sources.h"
#include "interflect/render/paths/surface_points.h"
#include "interflect/render/rays/traced_scene.h"

namespace interflect::detail {

/// Weights the scene's light sources by their visibility from the points, so that a bright lamp in another room does
/// not take the shadow rays of a dim lamp in this room. Returns nullopt if no weights are needed, because at least an
/// eighth of the unoccluded light arrives. The light of a point remains unbiased, and each source keeps at least half
/// of its shadow rays.
std::optional<LightSources> seen_sources(const TracedScene& scene, std::span<const SurfacePoint> points,
                                         std::uint64_t seed);

}  // namespace interflect::detail
