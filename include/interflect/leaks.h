/// @file
/// Light that a scene loses through gaps between its faces, or sends through one-sided faces in one direction only.
#pragma once

#include <cstdint>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect {

/// Rays that leave a scene, sampled from the surfaces of a solution.
struct Escapes {
    std::int64_t rays = 0;     ///< Rays traced; 0 if all surfaces are dark.
    std::int64_t escaped = 0;  ///< Rays that left the scene.
    /// Escaped rays for which most parallel rays, 2% of the scene's diagonal away, have a hit.
    std::int64_t through_gaps = 0;

    /// Fraction of the power leaving the surfaces that leaves the scene, in [0, 1]; 0 without rays.
    double share() const { return rays > 0 ? static_cast<double>(escaped) / static_cast<double>(rays) : 0; }
    /// Whether an apparently closed scene leaks: 0.1% to 5% of the rays escape, most through gaps. A room with an open
    /// door or window loses more.
    bool is_leak() const;
};

/// Traces 2^16 rays from the leaves of a solution, in proportion to their power (the sum of the channels of A (M + rho
/// H)). The directions have density cos(theta) / pi, so Escapes::share() is an unbiased estimate for that power, with a
/// standard error of at most 0.2%. Excludes light that luminaires send out of the scene.
/// @param ray_caster  Of the same scene, as is `solution`.
/// @return            The same for every call. Cost: O(leaves) and 2^16 rays, on the calling thread.
/// @throws InputError for a ray caster or a solution of another scene.
Escapes find_escapes(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

/// Error of a solution due to one-sided faces. Light and the rays of path tracing and gathering have opposite
/// directions and see different sides. Extra light passes through backs to places from which the fronts hide the
/// source. Missing light stops at fronts, although places behind them see the source through the backs. Shares are
/// relative to all received light.
struct OneWayLight {
    double share = 0;            ///< Extra minus missing light, both with interreflection.
    double reflected_share = 0;  ///< Interreflection only: the error of gathered light.
    std::uint32_t object = 0;    ///< Object that causes most of the error: index into Scene::objects.
    std::uint32_t material = 0;  ///< Its material: index into Scene::materials.
};

/// Estimates OneWayLight with 2^16 rays from surfaces and about as many from luminaires. Each ray is compared with its
/// reverse. A random walk from the place of extra or missing light samples how often that light is received; it ends at
/// the first ray that its reverse does not confirm. Light at places that send all of their light along such rays counts
/// 0: closed solids with faces outwards cause no error.
/// @param ray_caster  Of the same scene, as is `solution`.
/// @return            The same for every call; 0 for a scene without one-sided faces. Cost: O(leaves) and some 2^18
///                    rays, on the calling thread.
/// @throws InputError for a ray caster or a solution of another scene.
OneWayLight find_one_way_light(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

}  // namespace interflect
