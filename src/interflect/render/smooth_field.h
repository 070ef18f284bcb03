#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/render/element_vertices.h"

namespace interflect::inline detail {

/// Quantity of elements, such as irradiance, as a continuous function on each smooth surface. It is interpolated from
/// the corners of leaves, linearly on triangles and bilinearly on quadrilaterals, without cracks between large and
/// small leaves. An undivided patch without smooth neighbours has a constant value.
class SmoothField {
  public:
    /// @param forest    Must not change while the field is used; neither must `vertices`, which belong to this forest.
    /// @param values    One per element, in any unit; only leaves are used. A scalar is stored in all channels.
    /// @throws InputError if the sizes disagree.
    SmoothField(const ElementForest& forest, const ElementVertices& vertices, std::span<const Rgb> values);

    /// Returns the value at a point of a patch. Safe for concurrent calls.
    Rgb at(std::uint32_t patch, Parameters p) const;

  private:
    const ElementForest& forest_;
    const ElementVertices& vertices_;
    std::vector<Rgb> value_;  // per vertex
};

}  // namespace interflect::inline detail
