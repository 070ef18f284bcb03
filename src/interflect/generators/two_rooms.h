#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

struct TwoRoomsOptions {
    float turn = 0;          ///< Rotation of the partition about the vertical [degrees], -40 to 40.
    bool furniture = false;  ///< Two cabinets on each side of the partition, a sheet of paper on one.
};

/// Creates two sealed rooms of 4 x 4 x 3 m with common floor, ceiling and outer wall polygons. The partition is 1 cm
/// thick and reaches from floor to ceiling; a rotated one penetrates the outer walls. The only luminaire is in the
/// first room (x < 4), so light in the second has leaked. Views "lit" and "dark", one per room.
/// @throws InputError if the turn is out of range.
Scene make_two_rooms(const TwoRoomsOptions& options);

}  // namespace interflect::detail
