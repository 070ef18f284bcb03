#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth/element_vertices.h"

namespace interflect::detail {

/// Values at vertices whose interpolation has the irradiance of the leaves, after SmoothNormals: the mean of the leaves
/// around each vertex, weighted by their integrals of the vertex's basis function, which is 1 there and 0 at all
/// others. Linear in the irradiance, and >= 0. Interpolation keeps the power of each smooth surface, to rounding.
/// @param irradiance  Per element, >= 0; only leaves are used.
/// @throws InputError if sizes disagree. Cost: O(leaves).
std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> irradiance);

/// Makes values at vertices continuous: averages both sides of seams, and interpolates hanging vertices.
/// @param values  Per vertex; nullopt to ignore it.
/// @return        0 for ignored vertices.
std::vector<Rgb> joined_values(const ElementVertices& vertices, std::span<const std::optional<Rgb>> values);

}  // namespace interflect::detail
