#pragma once

#include <ImathBox.h>

#include "interflect/generators/building/floor_plan.h"
#include "interflect/scene.h"

namespace interflect::inline detail::building {

/// From where to look at a room: a corner, and the floor around the eye that furniture must leave free.
struct LookOut {
    View view;
    Imath::Box2f standing_room;
};

/// From the corner of room `index` that has a doorway nearest to the middle of its picture, at eye height, towards the
/// opposite corner. The eye is 0.45 m from both walls, as far as from what stands beside `standing_room`.
LookOut look_out(const FloorPlan& plan, std::uint32_t index);

/// The whole plan from above and south of it, "overview": one-sided ceilings and walls let the eye in.
View bird_view(const FloorPlan& plan);

/// Views are named in at most this many rooms, "room-0" and so on.
inline constexpr std::uint32_t most_room_views = 64;

}  // namespace interflect::inline detail::building
