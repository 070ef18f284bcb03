#pragma once

#include "interflect/scene.h"

namespace interflect::inline detail {

struct TwoRoomsOptions {
    float turn = 0;          ///< Of the wall between the rooms about the vertical [degrees], -40 to 40.
    bool furniture = false;  ///< Cabinets against that wall, two on each side, and a paper on one of them.
};

/// Two sealed rooms of 4 x 4 x 3 m under one ceiling polygon, on one floor polygon, between undivided outer walls. What
/// separates them is a wall 1 cm thick that stands on the floor, ends at the ceiling and, where it is turned, sticks in
/// the outer walls. The luminaire is in the first room (x < 4): any light in the second has leaked. Views "lit" and
/// "dark", one in each room.
/// @throws InputError where the turn is out of range.
Scene make_two_rooms(const TwoRoomsOptions& options);

}  // namespace interflect::inline detail
