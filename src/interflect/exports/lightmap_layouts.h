#pragma once

#include <vector>

#include "interflect/core.h"
#include "interflect/exports/flat_patches.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the objects' own layouts (Scene::lightmap_coordinates) of shown patches, x right and y down [m], with the
/// patches' total area in space. If both sides of a face are shown, only the first is included. Ignores layouts with
/// overlaps, patches of no area or a mostly empty rectangle.
/// @param warnings  Receives the objects with ignored layouts; may be null.
std::vector<FlatPatches> kept_layouts(const Scene& scene, const std::vector<bool>& shown, Warnings* warnings);

}  // namespace interflect::detail
