#pragma once

#include "interflect/scene.h"

namespace interflect::inline detail {

/// The scene with every patch divided into a grid of patches whose edges are at most `largest_edge` long: the fixed
/// mesh of a method that does not refine by itself. Quadrilaterals become grids, triangles become n^2 triangles;
/// patches that share an edge divide it alike. Sides stay neighbours, other_side included. Coordinates in textures and
/// lightmaps are interpolated.
/// @param largest_edge  [m], > 0.
/// @throws TooManyPatches where more than `max_patches` would result; InputError for another edge, and for a scene with
/// faults.
Scene split_patches(const Scene& scene, float largest_edge, std::uint64_t max_patches);

/// An edge length that shows light and shadow over the scene at a moderate cost: the diagonal of its bounding box
/// (core_bounds) over 48, larger where the scene's area would ask for more than about 200,000 patches [m].
float default_mesh_size(const Scene& scene);

/// The side of the smallest element where nothing else sets a limit: 5 mm, or a thousandth of the side of a typical
/// surface if that is less, as in a model in kilometres: half of the scene's area is in patches that are smaller. It
/// does not depend on the size of the world [m].
double default_element_size(const Scene& scene);

}  // namespace interflect::inline detail
