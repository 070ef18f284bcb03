#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Gives one vertex to each distinct position with its texture coordinates: what meets in a point shares a vertex
/// there. Numbers are compared as they are, in single precision; -0 counts as 0. Holds at most 16 bytes a vertex: a
/// hash table with linear probing, of indices into the vertices.
class VertexWeld {
  public:
    /// @param scene  New vertices go at the end; those that others add are not found.
    explicit VertexWeld(Scene& scene) : scene_(scene), slots_(16, none) {}

    /// The index of the vertex at `position`, which is added where it is new. @param position, coordinate  Finite.
    /// @param coordinate  Scene::texture_coordinates are kept from the first one on; a vertex without has (0, 0).
    std::uint32_t vertex(const V3f& position, const std::optional<V2f>& coordinate = std::nullopt);

  private:
    V2f coordinate_of(std::uint32_t vertex) const {
        return scene_.texture_coordinates.empty() ? V2f(0) : scene_.texture_coordinates[vertex];
    }
    std::uint32_t& slot_of(const V3f& position, const V2f& coordinate);
    void grow();

    Scene& scene_;
    std::vector<std::uint32_t> slots_;  // a power of two, never more than half full
    std::size_t used_ = 0;
};

}  // namespace interflect::inline detail
