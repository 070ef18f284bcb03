#pragma once

#include <cstddef>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Traces the share of this rank in the pictures, measurements and exports for which rank 0 passes Monitor::ranks,
/// until rank 0 calls end_shared_light(). For the other ranks.
/// @param scene     With the bits of rank 0, as `solution`.
/// @param solution  Null: rank 0 does not draw solutions.
void share_light(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, Ranks& ranks);

struct LightOfGroup {
    Scene scene;  ///< Other groups do not emit.
    Solution solution;
};

/// Returns a light group alone. O(elements).
/// @param group  Index into solution.group_names.
LightOfGroup light_of_group(const Scene& scene, const Solution& solution, std::size_t group);

/// Rank 0 ends share_light() in all other ranks. No effect for null.
void end_shared_light(Ranks* ranks);

}  // namespace interflect::detail
