#pragma once

#include <ImathBox.h>

#include "interflect/generators/building/floor_plan.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

/// A view from a corner of a room, and the floor to keep free around the camera.
struct LookOut {
    View view;
    Imath::Box2f standing_room;
};

/// View from a corner of room `index` at eye height to the opposite corner, with a doorway as close to the picture's
/// centre as possible. The camera is 0.45 m from walls and from objects beside `standing_room`.
LookOut look_out(const FloorPlan& plan, std::uint32_t index);

/// View "overview" of the whole plan from above and south, through one-sided faces.
View bird_view(const FloorPlan& plan);

/// Maximum number of rooms with a view, "room-0" and so on.
inline constexpr std::uint32_t most_room_views = 64;

}  // namespace interflect::detail::building
