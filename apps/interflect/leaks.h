#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::command {

/// How the rays of light leave a scene.
struct Escapes {
    std::int64_t rays = 0;     ///< That were traced.
    std::int64_t escaped = 0;  ///< Of these.
    std::int64_t through_gaps =
        0;  ///< Of these: most rays beside them, 2% of the scene's diagonal away, hit something.

    double share() const { return rays > 0 ? static_cast<double>(escaped) / static_cast<double>(rays) : 0; }
};

/// Traces 2^16 rays that start in proportion to the radiosity of a solution.
Escapes find_escapes(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

/// Whether a scene that looks closed leaks: more than 0.1% of the rays escape, less than 5% (a room with a door or a
/// window open loses more), and most of those that do pass through gaps.
bool leaks(const Escapes& escapes);

/// Error of a solution that one-sided faces cause. The solver follows light; path tracing and gathering trace rays in
/// the opposite direction, which see different sides. Extra light passes through backs to places from which the fronts
/// hide the source. Missing light is stopped by fronts, although places behind them see the source through the backs.
/// Shares are relative to the light that all surfaces receive.
struct OneWayLight {
    double share = 0;                        ///< Extra minus missing light, both with their interreflection.
    double reflected_share = 0;              ///< Interreflection only: the error of light gathered from the solution.
    std::uint32_t object = 0, material = 0;  ///< The faces that cause most of the error.
};

/// Traces 2^16 rays from surfaces and 2^16 from luminaires, each in both directions. Closed solids whose faces look
/// outwards cause no error: no light leaves them along a line of sight.
OneWayLight find_one_way_light(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

}  // namespace interflect::command
