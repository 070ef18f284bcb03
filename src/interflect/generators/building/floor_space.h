#pragma once

#include <ImathBox.h>

#include <optional>
#include <vector>

#include "interflect/generators/building/floor_plan.h"
#include "interflect/generators/building/furniture.h"
#include "interflect/generators/building/random_sequence.h"
#include "interflect/generators/building/solids.h"

namespace interflect::detail::building {

/// Free floor area of a room, for placing furniture.
class FloorSpace {
  public:
    /// Reserves only the ways through the doorways.
    FloorSpace(const FloorPlan& plan, const Room& room);

    void reserve(const Imath::Box2f& part) { taken_.push_back(part); }

    /// Finds and reserves a place with the back to a wall; nullopt if none is free.
    std::optional<Placement> against_wall(const Furniture& piece, RandomSequence& random);
    /// The same, away from the walls.
    std::optional<Placement> in_the_open(const Furniture& piece, RandomSequence& random);

  private:
    std::optional<Placement> take_if_free(const Furniture& piece, Side back, const Imath::V2f& origin);

    Room room_;
    std::vector<Imath::Box2f> taken_;
};

}  // namespace interflect::detail::building
