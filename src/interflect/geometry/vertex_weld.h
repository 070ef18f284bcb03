#pragma once

#include <cstdint>
#include <vector>

#include "interflect/geometry/vertex_coordinates.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Merges vertices with equal position and attributes in single precision (-0 equals 0). A hash table of vertex indices
/// with linear probing; at most 16 bytes a vertex.
class VertexWeld {
  public:
    /// @param scene  New vertices are appended; vertices added by others are not found.
    explicit VertexWeld(Scene& scene) : scene_(scene), slots_(16, none) {}

    /// Index of the vertex, added by add_vertex() if new. All numbers must be finite.
    std::uint32_t vertex(const V3f& position, const VertexCoordinates& coordinates = {});

  private:
    std::uint32_t& slot_of(const V3f& position, const VertexCoordinates& coordinates);
    void grow();

    Scene& scene_;
    std::vector<std::uint32_t> slots_;  // a power of two, never more than half full
    std::size_t used_ = 0;
};

}  // namespace interflect::detail
