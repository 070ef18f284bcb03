#pragma once

#include <cstddef>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Helps rank 0 from another rank: traces the share of this rank in the pictures, measurements and exports for which
/// rank 0 passes Monitor::ranks. Returns when rank 0 calls end_shared_light().
/// @param scene     Must have the same bits as in rank 0, like `solution`.
/// @param solution  Null if rank 0 does not draw solutions.
void share_light(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, Ranks& ranks);

struct LightOfGroup {
    Scene scene;  ///< Scene in which the other groups do not emit.
    Solution solution;
};

/// Returns the scene and solution of a single light group. Cost: O(elements).
/// @param group  Index into solution.group_names.
LightOfGroup light_of_group(const Scene& scene, const Solution& solution, std::size_t group);

/// Ends share_light() in all other ranks. Only rank 0 calls this; without `ranks`, it has no effect.
void end_shared_light(Ranks* ranks);

}  // namespace interflect::detail
