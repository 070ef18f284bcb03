#pragma once

#include <span>

#include "interflect/generators/building/floor_plan.h"
#include "interflect/scene.h"

namespace interflect::inline detail::building {

/// Materials of a room's surfaces.
struct Finish {
    std::uint32_t wall = 0, floor = 0, ceiling = 0;
};

/// Adds floors, walls, ceilings and the insides of doorways. All are one-sided, lit from inside, and form one closed
/// surface without T-vertices: every edge belongs to exactly two patches, which run along it in opposite directions.
/// Walls, floors and ceilings are divided only at the edges of doorways. Objects are named "room-0.shell" and so on; a
/// doorway belongs to its first room and uses that room's materials.
/// @param finishes  One for each room.
void add_shell(Scene& scene, const FloorPlan& plan, std::span<const Finish> finishes);

}  // namespace interflect::inline detail::building
