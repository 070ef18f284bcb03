#pragma once

#include <cstdint>
#include <vector>

#include "interflect/geometry/vertex_coordinates.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Gives one vertex to each distinct position with its attributes: faces that meet in a point share a vertex there.
/// Numbers are compared as they are, in single precision; -0 counts as 0. Holds at most 16 bytes a vertex: a hash table
/// with linear probing, of indices into the vertices.
class VertexWeld {
  public:
    /// @param scene  New vertices go at the end; those that others add are not found.
    explicit VertexWeld(Scene& scene) : scene_(scene), slots_(16, none) {}

    /// The index of the vertex at `position`, which add_vertex() adds where it is new. All numbers are finite.
    std::uint32_t vertex(const V3f& position, const VertexCoordinates& coordinates = {});

  private:
    std::uint32_t& slot_of(const V3f& position, const VertexCoordinates& coordinates);
    void grow();

    Scene& scene_;
    std::vector<std::uint32_t> slots_;  // a power of two, never more than half full
    std::size_t used_ = 0;
};

}  // namespace interflect::inline detail
