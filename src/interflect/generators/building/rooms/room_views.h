#pragma once

#include <ImathBox.h>

#include "interflect/generators/building/plan/floor_plan.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

struct RoomView {
    View view;
    Imath::Box2f standing_room;  ///< Floor around the camera, without furniture.
};

/// Returns the view from the corner that shows a doorway closest to the centre, 0.45 m from walls and from objects
/// outside `standing_room`.
RoomView room_view(const FloorPlan& plan, std::uint32_t index);

/// Returns "overview" from above and south, through the backs of the ceilings.
View bird_view(const FloorPlan& plan);

inline constexpr std::uint32_t max_room_views = 64;

}  // namespace interflect::detail::building
