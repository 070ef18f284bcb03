#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::inline detail {

struct BoxesOptions {
    static constexpr std::uint32_t most_boxes = 100'000;

    std::uint32_t boxes = 20;  ///< 1 to most_boxes.
    std::uint64_t seed = 1;    ///< Same options, same scene.
    bool texture = false;      ///< Tiles on the floor, labels on the boxes, louvres before the luminaires.
};

/// One closed room, square, 2.8 m high and about the origin, with boxes of random sizes, turns and colours on its
/// floor, about one to 1.4 m^2, and luminaires on its ceiling. Six one-sided patches a box and a luminaire, and ten of
/// the room. Views "room-0", from a corner, and "overview". Boxes keep at least 4 mm distance from each other and the
/// room. With textures, the patches that have one have vertices of their own. Time and memory are linear in the boxes.
/// @throws InputError where their number is out of range.
Scene make_boxes(const BoxesOptions& options);

}  // namespace interflect::inline detail
