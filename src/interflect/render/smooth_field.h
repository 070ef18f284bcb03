#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/render/element_vertices.h"

namespace interflect::inline detail {

/// A quantity of elements, such as irradiance, as a function on the scene's surfaces that is continuous wherever
/// they are smooth: interpolated from the corners of leaves, linearly on a triangle and bilinearly on a quadrilateral,
/// without cracks where large leaves meet small ones. A patch that is whole and has no smooth neighbours keeps its one
/// value.
class SmoothField {
  public:
    /// @param forest    Stays as it is while the field is used, like `vertices`, which are of this forest.
    /// @param values    One an element, in any unit; only those of leaves count. A scalar goes as a grey.
    /// @throws InputError where the sizes disagree.
    SmoothField(const ElementForest& forest, const ElementVertices& vertices, std::span<const Rgb> values);

    /// The value at a point of a patch. Any number of threads may call it.
    Rgb at(std::uint32_t patch, Parameters p) const;

  private:
    const ElementForest& forest_;
    const ElementVertices& vertices_;
    std::vector<Rgb> value_;  // of each vertex
};

}  // namespace interflect::inline detail
