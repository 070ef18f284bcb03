#pragma once

#include <span>

#include "interflect/generators/building/plan/floor_plan.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

struct Finish {
    std::uint32_t wall = 0, floor = 0, ceiling = 0;
};

/// Adds rooms and insides of doorways as one closed surface of inward faces without T-vertices: objects "room-0.shell"
/// and so on. A doorway belongs to its first room. @param finishes  One per room.
void add_shell(Scene& scene, const FloorPlan& plan, std::span<const Finish> finishes);

}  // namespace interflect::detail::building
