#pragma once

#include <span>

#include "interflect/generators/building/floor_plan.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

struct Finish {
    std::uint32_t wall = 0, floor = 0, ceiling = 0;
};

/// Adds floors, walls, ceilings and the insides of doorways: one closed surface of one-sided faces lit from inside,
/// without T-vertices. Every edge belongs to exactly two patches, in opposite directions. Faces are divided only at the
/// edges of doorways. Objects are named "room-0.shell" and so on; a doorway belongs to its first room, with that room's
/// materials.
/// @param finishes  One for each room.
void add_shell(Scene& scene, const FloorPlan& plan, std::span<const Finish> finishes);

}  // namespace interflect::detail::building
