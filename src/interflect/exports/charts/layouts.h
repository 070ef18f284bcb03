#pragma once

#include <vector>

#include "interflect/core.h"
#include "interflect/exports/mesh/flat_patches.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the objects' own layouts (Scene::lightmap_coordinates; docs/files/export.md) with y pointing downwards,
/// scaled to the area of the patches [m]. If both sides of a face are shown, the layout contains the first side.
/// @param warnings  Receives a warning for each object whose layout is ignored; may be null.
std::vector<FlatPatches> kept_layouts(const Scene& scene, const std::vector<bool>& shown, Warnings* warnings);

}  // namespace interflect::detail
