#pragma once

#include <ImathBox.h>

#include "interflect/generators/building/floor_plan.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

struct LookOut {
    View view;
    Imath::Box2f standing_room;  ///< Floor around the camera to keep free.
};

/// Returns the view of room `index` from the corner that shows a doorway closest to the picture's centre. The camera is
/// 0.45 m from walls and from objects outside `standing_room`.
LookOut look_out(const FloorPlan& plan, std::uint32_t index);

/// Returns the view "overview" of the plan from above and south, through the backs of the ceilings.
View bird_view(const FloorPlan& plan);

inline constexpr std::uint32_t most_room_views = 64;

}  // namespace interflect::detail::building
