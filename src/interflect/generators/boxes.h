#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

struct BoxesOptions {
    static constexpr std::uint32_t most_boxes = 100'000;

    std::uint32_t boxes = 20;  ///< 1 to most_boxes.
    std::uint64_t seed = 1;    ///< Equal options give equal scenes.
    bool texture = false;      ///< Tiles on the floor, labels on the boxes, louvres before the luminaires.
};

/// Creates a closed, square room about the origin, 2.8 m high, with luminaires on its ceiling and about one box per 1.4
/// m^2 of floor, of random size, rotation and colour. Boxes and luminaires have six one-sided patches each, the room
/// ten. Views "room-0", from a corner, and "overview". Boxes keep at least 4 mm distance. Textured patches have their
/// own vertices. Time and memory are linear in the boxes.
/// @throws InputError if the number of boxes is out of range.
Scene make_boxes(const BoxesOptions& options);

}  // namespace interflect::detail
