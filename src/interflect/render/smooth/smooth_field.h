#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth/element_vertices.h"

namespace interflect::detail {

/// Interpolates values of elements, continuously on each smooth surface: linearly on triangles and bilinearly on
/// quadrilaterals.
class SmoothField {
  public:
    /// @param forest, vertices  Must not change during use.
    /// @param values            One value per element; only leaves are used.
    /// @throws InputError if sizes disagree.
    SmoothField(const ElementForest& forest, const ElementVertices& vertices, std::span<const Rgb> values);

    /// Returns the interpolated value. Thread-safe.
    Rgb at(PatchIndex patch, Parameters p) const;

  private:
    const ElementForest& forest_;
    const ElementVertices& vertices_;
    std::vector<Rgb> value_;  // of each vertex
};

}  // namespace interflect::detail
