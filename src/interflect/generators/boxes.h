#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

struct BoxesOptions {
    static constexpr std::uint32_t max_boxes = 100'000;

    std::uint32_t boxes = 20;  ///< 1 to max_boxes.
    std::uint64_t seed = 1;
    bool texture = false;
};

/// Creates a closed, square room about the origin, 2.8 m high, with ceiling luminaires and a random box per 1.4 m^2 of
/// floor, at least 4 mm apart. Views "room-0" and "overview". @throws InputError for options out of range.
Scene make_boxes(const BoxesOptions& options);

}  // namespace interflect::detail
