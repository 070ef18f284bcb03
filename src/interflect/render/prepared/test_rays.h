#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/render/paths/surface_points.h"
#include "interflect/render/rays/traced_scene.h"

namespace interflect::detail {

/// A ray from a point to a sampled light source or bright element.
struct TestRay {
    std::uint32_t source = none;  ///< Index of the source; none: no source was found.
    Ray ray;
    PatchIndex patch{};  ///< Target patch, as in ShadowRays.
    float distance = 0;  ///< [m]
    float light = 0;     ///< Unoccluded irradiance over its density, sum of channels [as H].
};

/// Number of test rays that were sent to each source and arrived there, and the total light of these rays.
struct TestedSources {
    std::vector<float> sent, arrived;
    double light_sent = 0, light_arrived = 0;
};

/// Returns the number of test rays for these points: about one per point, a small part of the rays that light it.
std::size_t test_rays_for(std::span<const SurfacePoint> points);

const SurfacePoint& random_point(std::span<const SurfacePoint> points, std::uint32_t word);

/// Traces `count` test rays.
/// @param sources  Greater than every TestRay::source.
/// @param sample   Returns the i-th test ray, i < count; thread-safe.
TestedSources send_test_rays(const TracedScene& scene, std::size_t sources, std::size_t count,
                             const std::function<TestRay(std::size_t)>& sample);

}  // namespace interflect::detail
