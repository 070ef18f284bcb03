#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::inline detail {

struct BoxesOptions {
    static constexpr std::uint32_t most_boxes = 100'000;

    std::uint32_t boxes = 20;  ///< 1 to most_boxes.
    std::uint64_t seed = 1;    ///< Equal options give equal scenes.
    bool texture = false;      ///< Tiles on the floor, labels on the boxes, louvres before the luminaires.
};

/// Creates one closed, square room, 2.8 m high and centred at the origin. Boxes of random size, rotation and colour
/// stand on its floor, about one per 1.4 m^2; luminaires hang from its ceiling. A box or a luminaire has six one-sided
/// patches, the room has ten. Views "room-0", from a corner, and "overview". Boxes keep at least 4 mm distance from
/// each other and from the room. Textured patches have their own vertices. Time and memory are linear in the boxes.
/// @throws InputError if the number of boxes is out of range.
Scene make_boxes(const BoxesOptions& options);

}  // namespace interflect::inline detail
