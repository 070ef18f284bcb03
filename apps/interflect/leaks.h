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

/// Light that goes through the backs of one-sided faces to where nothing that looks the other way sees it come from:
/// paths from the camera are stopped by their fronts.
struct OneWayLight {
    double share = 0;  ///< Of the light that hits anything, of surfaces or of luminaires, where that is more.
    std::uint32_t object = 0, material = 0;  ///< Of the faces that are in the way most often.
};

/// Traces 2^16 rays of each, forth and back.
OneWayLight find_one_way_light(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

}  // namespace interflect::command
