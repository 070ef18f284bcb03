#pragma once

#include "interflect/scene.h"

namespace interflect::inline detail {

struct TwoRoomsOptions {
    float turn = 0;          ///< Rotation of the partition wall about the vertical [degrees], -40 to 40.
    bool furniture = false;  ///< Cabinets against that wall, two on each side, and a sheet of paper on one of them.
};

/// Creates two sealed rooms of 4 x 4 x 3 m that share one floor polygon, one ceiling polygon and undivided outer walls.
/// The partition wall is 1 cm thick, stands on the floor and ends at the ceiling; a rotated wall penetrates the outer
/// walls. The luminaire is in the first room (x < 4), so any light in the second room has leaked. Views "lit" and
/// "dark", one in each room.
/// @throws InputError if the turn is out of range.
Scene make_two_rooms(const TwoRoomsOptions& options);

}  // namespace interflect::inline detail
