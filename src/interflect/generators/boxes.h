#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

struct BoxesOptions {
    static constexpr std::uint32_t most_boxes = 100'000;

    std::uint32_t boxes = 20;  ///< 1 to most_boxes.
    std::uint64_t seed = 1;    ///< Equal options give equal scenes.
    bool texture = false;
};

/// Creates a closed, square room about the origin, 2.8 m high, with ceiling luminaires and about one box per 1.4 m^2 of
/// floor, of random size, rotation and colour. A box or luminaire has six one-sided patches, the room ten. Boxes are at
/// least 4 mm apart. Textured patches have their own vertices. Views "room-0" and "overview". Linear in the boxes.
/// @throws InputError if the number of boxes is out of range.
Scene make_boxes(const BoxesOptions& options);

}  // namespace interflect::detail
