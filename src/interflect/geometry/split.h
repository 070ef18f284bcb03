#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

/// Divides every patch into a grid with edges of at most `largest_edge`, for methods without refinement. Triangles
/// become n^2 triangles. Divides shared edges equally, interpolates attributes and keeps both sides of a face linked.
/// @param largest_edge  [m], > 0.
/// @throws TooManyPatches above `max_patches`; InputError for an invalid edge or a scene with faults.
Scene split_patches(const Scene& scene, float largest_edge, std::uint64_t max_patches);

/// Returns a default edge length [m]: 1/48 of the diagonal of core_bounds(), or more to limit the mesh to about 200,000
/// patches.
float default_mesh_size(const Scene& scene);

/// Returns a default minimum element side [m]: 5 mm, or a thousandth of the typical patch side if that is smaller. Half
/// of the scene's area lies in patches smaller than the typical one.
double default_element_size(const Scene& scene);

}  // namespace interflect::detail
