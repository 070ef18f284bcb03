#pragma once

#include <ImathBox.h>

#include <optional>
#include <vector>

#include "interflect/generators/building/plan/floor_plan.h"
#include "interflect/generators/building/plan/random_sequence.h"
#include "interflect/generators/building/rooms/furniture.h"
#include "interflect/generators/building/walls/solids.h"

namespace interflect::detail::building {

/// Finds free floor for the furniture of a room.
class FloorSpace {
  public:
    /// Reserves the floor before the doorways.
    FloorSpace(const FloorPlan& plan, const Room& room);

    void reserve(const Imath::Box2f& part) { taken_.push_back(part); }

    /// Reserves a place with the piece's back to a wall; nullopt on failure.
    std::optional<Placement> against_wall(const Furniture& piece, RandomSequence& random);
    std::optional<Placement> in_the_open(const Furniture& piece, RandomSequence& random);

  private:
    std::optional<Placement> reserve_if_free(const Furniture& piece, Side back, const Imath::V2f& origin);

    Room room_;
    std::vector<Imath::Box2f> taken_;
};

}  // namespace interflect::detail::building
