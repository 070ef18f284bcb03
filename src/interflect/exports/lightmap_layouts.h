#pragma once

#include <vector>

#include "interflect/exports/flat_patches.h"
#include "interflect/scene.h"
#include "interflect/warnings.h"

namespace interflect::inline detail {

/// The layouts that objects bring along (Scene::lightmap_coordinates), of their shown patches that have coordinates: to
/// the right and down [m], so that the patches of an object have the same area in it as in space. Of a face whose two
/// sides are shown, the first is in it. Ignored is the layout of an object of which a patch has no area in it, or two
/// patches overlap, or that leaves most of its rectangle empty.
/// @param warnings  Gets the objects whose layouts are ignored; may be null.
std::vector<FlatPatches> kept_layouts(const Scene& scene, const std::vector<bool>& shown, Warnings* warnings);

}  // namespace interflect::inline detail
