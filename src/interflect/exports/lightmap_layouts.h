#pragma once

#include <vector>

#include "interflect/exports/flat_patches.h"
#include "interflect/scene.h"
#include "interflect/warnings.h"

namespace interflect::inline detail {

/// Returns the objects' own layouts (Scene::lightmap_coordinates) of shown patches with coordinates. Axes point right
/// and down [m]; a layout has the same total area as its patches in space. If both sides of a face are shown, the
/// layout contains the first. Layouts with patches of no area, overlaps or a mostly empty rectangle are ignored.
/// @param warnings  Receives the objects with ignored layouts; may be null.
std::vector<FlatPatches> kept_layouts(const Scene& scene, const std::vector<bool>& shown, Warnings* warnings);

}  // namespace interflect::inline detail
