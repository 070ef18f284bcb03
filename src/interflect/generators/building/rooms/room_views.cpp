#include "interflect/generators/building/rooms/room_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace interflect::detail::building {

namespace {

using Imath::Box2f;
using Imath::V2f;

constexpr float eye_height = 1.6f;     // [m]
constexpr float eye_to_wall = 0.45f;   // [m]
constexpr float wide = 55;             // vertical [degrees]
constexpr float aim_height = 1.0f;     // [m]
constexpr float bird_fov = 45;         // [degrees]
constexpr float bird_distance = 1.1f;  // relative to the plan's diagonal

/// -1 or 1 per axis.
struct Corner {
    float x, y;
};
constexpr std::array<Corner, 4> room_corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};

/// Rounds coordinates to shorten the decimals in files.
Imath::V3d rounded_to_micrometres(const V3f& x) {
    const auto rounded = [](float coordinate) { return std::round(static_cast<double>(coordinate) * 1e6) / 1e6; };
    return {rounded(x.x), rounded(x.y), rounded(x.z)};
}

V2f eye_in(const Room& room, const Corner& corner) {
    return {corner.x < 0 ? room.x.low + eye_to_wall : room.x.high - eye_to_wall,
            corner.y < 0 ? room.y.low + eye_to_wall : room.y.high - eye_to_wall};
}

V2f opposite_corner(const Room& room, const Corner& corner) {
    return {corner.x < 0 ? room.x.high : room.x.low, corner.y < 0 ? room.y.high : room.y.low};
}

V2f middle_of_doorway(const FloorPlan& plan, const Room& room, Side side) {
    const float along = plan.doorways[room.doorway[side]].opening.middle();
    return along_x(side) ? V2f(along, room.wall(side)) : V2f(room.wall(side), along);
}

/// Returns the cosine between view direction and nearest doorway; -1 without doorways.
float doorway_in_sight(const FloorPlan& plan, const Room& room, const Corner& corner) {
    const V2f eye = eye_in(room, corner), direction = (opposite_corner(room, corner) - eye).normalized();
    float best = -1;
    for (const Side side : {west, south, east, north})
        if (room.doorway[side] != none)
            best = std::max(best, direction.dot((middle_of_doorway(plan, room, side) - eye).normalized()));
    return best;
}

}  // namespace

RoomView room_view(const FloorPlan& plan, std::uint32_t index) {
    const Room& room = plan.rooms[index];
    const Corner& corner =
        *std::max_element(room_corners.begin(), room_corners.end(), [&](const Corner& a, const Corner& b) {
            return doorway_in_sight(plan, room, a) < doorway_in_sight(plan, room, b);
        });
    const V2f eye = eye_in(room, corner), aim = opposite_corner(room, corner);
    RoomView result;
    result.view = {fmt::format("room-{}", index), rounded_to_micrometres({eye.x, eye.y, eye_height}),
                   rounded_to_micrometres({aim.x, aim.y, aim_height}), V3f(0, 0, 1), wide};
    result.standing_room = Box2f(eye - V2f(eye_to_wall), eye + V2f(eye_to_wall));
    return result;
}

View bird_view(const FloorPlan& plan) {
    Box2f extent;
    for (const Room& room : plan.rooms) {
        extent.extendBy(V2f(room.x.low, room.y.low));
        extent.extendBy(V2f(room.x.high, room.y.high));
    }
    const V2f middle = extent.center();
    const V3f look_at(middle.x, middle.y, 0);
    const V3f from = V3f(0, -0.45f, 1).normalized() * extent.size().length() * bird_distance;
    return {"overview", rounded_to_micrometres(look_at + from), rounded_to_micrometres(look_at), V3f(0, 0, 1),
            bird_fov};
}

}  // namespace interflect::detail::building
