#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

struct TwoRoomsOptions {
    float turn = 0;          ///< Rotation of the partition wall about the vertical [degrees], -40 to 40.
    bool furniture = false;  ///< Two cabinets on each side of that wall, and a sheet of paper on one of them.
};

/// Creates two sealed rooms of 4 x 4 x 3 m with common floor, ceiling and outer wall polygons. The partition is 1 cm
/// thick, stands on the floor and ends at the ceiling; a rotated one penetrates the outer walls. The luminaire is in
/// the first room (x < 4): any light in the second has leaked. Views "lit" and "dark", one in each room.
/// @throws InputError if the turn is out of range.
Scene make_two_rooms(const TwoRoomsOptions& options);

}  // namespace interflect::detail
