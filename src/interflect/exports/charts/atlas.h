#pragma once

#include <ImathVec.h>

#include <vector>

#include "interflect/exports/lightmap/lightmap_charts.h"

namespace interflect::detail {

/// Packs charts into images, and rotates some of them. Returns the sizes of the images, which are multiples of 4.
/// @param max_size  Largest side, a multiple of 4; must hold each chart with gutters.
std::vector<Imath::V2i> pack_charts(std::vector<LightmapChart>& charts, int gutter, int max_size);

}  // namespace interflect::detail
