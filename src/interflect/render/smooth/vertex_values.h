#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth/element_vertices.h"

namespace interflect::detail {

/// Computes values at vertices for interpolation of the irradiance of the leaves, after SmoothNormals. The value at a
/// vertex is the mean over the leaves around it, weighted by their integrals of the vertex's basis function, which is 1
/// at this vertex and 0 at all others. Linear in the irradiance, and >= 0. Interpolation preserves the power of each
/// smooth surface, to rounding.
/// @param irradiance  One value per element, >= 0; only leaves are used.
/// @throws InputError if sizes disagree. Cost: O(leaves).
std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> irradiance);

/// Makes values at vertices continuous: averages both sides of seams, and interpolates hanging vertices.
/// @param values  One value per vertex; nullopt for vertices to ignore.
/// @return        One value per vertex; 0 for ignored vertices.
std::vector<Rgb> joined_values(const ElementVertices& vertices, std::span<const std::optional<Rgb>> values);

}  // namespace interflect::detail
