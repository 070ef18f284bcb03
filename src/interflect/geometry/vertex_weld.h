#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene/scene.h"

namespace interflect {

/// Gives one vertex to each distinct position: what meets in a point shares a vertex there. Positions are compared as
/// they are, in single precision; -0 counts as 0. Holds at most 16 bytes a vertex: a hash table with linear probing, of
/// indices into the vertices.
class VertexWeld {
  public:
    /// @param vertices  New ones go at the end; those that others add are not found.
    explicit VertexWeld(std::vector<V3f>& vertices) : vertices_(vertices), slots_(16, none) {}

    /// The index of the vertex at `position`, which is added where it is new. @param position  Finite.
    std::uint32_t vertex(const V3f& position);

  private:
    std::uint32_t& slot_of(const V3f& position);
    void grow();

    std::vector<V3f>& vertices_;
    std::vector<std::uint32_t> slots_;  // a power of two, never more than half full
    std::size_t used_ = 0;
};

}  // namespace interflect
