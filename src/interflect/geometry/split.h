#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

/// Divides every patch into a grid with edges of at most `largest_edge`: the fixed mesh of methods without refinement.
/// Triangles become n^2 triangles. Patches that share an edge divide it equally. The two sides of a face stay
/// neighbours, with other_side set. Texture and lightmap coordinates are interpolated.
/// @param largest_edge  [m], > 0.
/// @throws TooManyPatches if the result would exceed `max_patches`; InputError for another edge or a scene with faults.
Scene split_patches(const Scene& scene, float largest_edge, std::uint64_t max_patches);

/// Default edge length [m]: the diagonal of the bounding box (core_bounds) over 48, or larger to limit the mesh to
/// about 200,000 patches.
float default_mesh_size(const Scene& scene);

/// Default minimum side of elements [m]: 5 mm, or a thousandth of the typical patch side if that is less. Half of the
/// scene's area is in patches smaller than the typical one. Independent of the scene's extent.
double default_element_size(const Scene& scene);

}  // namespace interflect::detail
