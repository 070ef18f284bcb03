#pragma once

#include <vector>

#include "interflect/core.h"
#include "interflect/exports/mesh/flat_patches.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the objects' own layouts (Scene::lightmap_coordinates; docs/files/export.md), y downwards, scaled to the
/// area of the patches [m]; of two shown sides, the first.
/// @param warnings  Receives objects with ignored layouts; may be null.
std::vector<FlatPatches> kept_layouts(const Scene& scene, const std::vector<bool>& shown, Warnings* warnings);

}  // namespace interflect::detail
