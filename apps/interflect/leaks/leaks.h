#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::command {

struct Escapes {
    std::int64_t rays = 0;
    std::int64_t escaped = 0;       ///< Rays that left the scene.
    std::int64_t through_gaps = 0;  ///< Escaped rays with hits of most parallel rays, 2% of the scene's diagonal away.

    double share() const { return rays > 0 ? static_cast<double>(escaped) / static_cast<double>(rays) : 0; }
};

/// Traces 2^16 rays in proportion to the power of a solution's leaves.
Escapes find_escapes(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

/// Returns whether an apparently closed scene leaks: 0.1% to 5% of the rays escape, most through gaps. A room with an
/// open door or window loses more.
bool leaks(const Escapes& escapes);

/// Error of a solution due to one-sided faces. Light and the rays of path tracing and gathering have opposite
/// directions and see different sides. Extra light passes through backs to places from which the fronts hide the
/// source. Missing light stops at fronts, although places behind them see the source through the backs. Shares are
/// relative to all received light.
struct OneWayLight {
    double share = 0;                        ///< Extra minus missing light, both with interreflection.
    double reflected_share = 0;              ///< Interreflection only: the error of gathered light.
    std::uint32_t object = 0, material = 0;  ///< Faces that cause most of the error.
};

/// Traces 2^16 rays from surfaces and from luminaires, in both directions. Closed solids with faces outwards cause no
/// error: no light leaves them along a line of sight.
OneWayLight find_one_way_light(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

}  // namespace interflect::command
