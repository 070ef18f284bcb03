#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

struct TwoRoomsOptions {
    float turn = 0;          ///< About the vertical [degrees], -40 to 40.
    bool furniture = false;  ///< Two cabinets per side, paper on one.
};

/// Creates two sealed rooms of 4 x 4 x 3 m with common floor, ceiling and outer wall polygons, which a rotated
/// partition penetrates. The only luminaire is in the first (x < 4): light in the second has leaked. Views "lit" and
/// "dark".
/// @throws InputError if the turn is out of range.
Scene make_two_rooms(const TwoRoomsOptions& options);

}  // namespace interflect::detail
