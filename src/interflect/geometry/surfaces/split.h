#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

/// Divides patches into grids, for methods without refinement. Triangles become n^2 triangles.
/// @param largest_edge  Maximum edge of the pieces [m], > 0.
/// @throws InputError above `max_patches`, for an invalid edge and a scene with faults.
Scene split_patches(const Scene& scene, float largest_edge, std::uint64_t max_patches);

/// Returns an edge length [m]: 1/48 of the diagonal of core_bounds(), or more for at most about 200,000 patches.
float default_mesh_size(const Scene& scene);

/// Returns a minimum element side [m]: 5 mm, at most a thousandth of the area-weighted median patch side.
double default_element_size(const Scene& scene);

}  // namespace interflect::detail
