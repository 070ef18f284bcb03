#pragma once

#include <cstdint>
#include <string_view>

#include "interflect/generators/building/plan/floor_plan.h"
#include "interflect/generators/building/rooms/furniture.h"
#include "interflect/generators/building/walls/palette.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

/// Adds furniture as objects "room-0.table-1" and so on.
class Furnisher {
  public:
    Furnisher(Scene& scene, const Palette& palette, std::uint32_t room, RandomSequence& random)
        : scene_(scene), palette_(palette), room_(room), random_(random) {}

    void add(const Furniture& piece, const Placement& place);
    /// Adds at least one, evenly spaced by at most `pitch` [m].
    void add_luminaires(const Room& room, float ceiling_height, float pitch, bool turned);

  private:
    std::uint32_t add_object(std::string_view name);

    Scene& scene_;
    const Palette& palette_;
    std::uint32_t room_;
    RandomSequence& random_;
    std::uint32_t count_ = 0;
};

}  // namespace interflect::detail::building
