#pragma once

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Divides every patch into a grid of patches with edges of at most `largest_edge`: the fixed mesh of methods without
/// refinement. Quadrilaterals become grids, triangles become n^2 triangles; patches that share an edge divide it
/// equally. The two sides of a face stay neighbours, with other_side set. Texture and lightmap coordinates are
/// interpolated.
/// @param largest_edge  [m], > 0.
/// @throws TooManyPatches if the result would exceed `max_patches`; InputError for another edge or a scene with faults.
Scene split_patches(const Scene& scene, float largest_edge, std::uint64_t max_patches);

/// Default edge length that resolves light and shadow at moderate cost [m]: the diagonal of the bounding box
/// (core_bounds) over 48, or larger if the scene's area would give more than about 200,000 patches.
float default_mesh_size(const Scene& scene);

/// Default side of the smallest element [m]: 5 mm, or less for small models: a thousandth of the side of a typical
/// patch. Half of the scene's area is in patches smaller than the typical one. Independent of the extent of the scene.
double default_element_size(const Scene& scene);

}  // namespace interflect::inline detail
