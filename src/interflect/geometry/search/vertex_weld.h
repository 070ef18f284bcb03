#pragma once

#include <cstdint>
#include <vector>

#include "interflect/geometry/polygons/vertex_coordinates.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Merges vertices with equal positions and attributes (-0 equals 0).
class VertexWeld {
  public:
    /// @param scene  Receives new vertices. Vertices added elsewhere are not found.
    explicit VertexWeld(Scene& scene) : scene_(scene), slots_(16, none) {}

    /// Returns the index of a new or an existing vertex. Requires finite numbers.
    std::uint32_t vertex(const V3f& position, const VertexCoordinates& coordinates = {});

  private:
    std::uint32_t& slot_of(const V3f& position, const VertexCoordinates& coordinates);
    void grow();

    Scene& scene_;
    std::vector<std::uint32_t> slots_;  // hash table of a power of two slots, at most half full
    std::size_t used_ = 0;
};

}  // namespace interflect::detail
