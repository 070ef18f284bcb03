#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/element_vertices.h"

namespace interflect::detail {

/// Quantity of elements, such as irradiance, as a continuous function on each smooth surface: linear on triangles,
/// bilinear on quadrilaterals, without cracks between levels. An undivided patch without smooth neighbours is constant.
class SmoothField {
  public:
    /// @param forest    Must not change during use, like `vertices`, which must belong to it.
    /// @param values    Per element, in any unit; only leaves are used. Scalars are passed as grey.
    /// @throws InputError if the sizes disagree.
    SmoothField(const ElementForest& forest, const ElementVertices& vertices, std::span<const Rgb> values);

    /// Returns the value at a point of a patch. Thread-safe.
    Rgb at(std::uint32_t patch, Parameters p) const;

  private:
    const ElementForest& forest_;
    const ElementVertices& vertices_;
    std::vector<Rgb> value_;  // per vertex
};

}  // namespace interflect::detail
