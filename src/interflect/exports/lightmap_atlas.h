#pragma once

#include <ImathVec.h>

#include <vector>

#include "interflect/exports/lightmap_charts.h"

namespace interflect::inline detail {

/// Places charts in images, each with a gutter around it, and rotates charts that fit better so.
/// @param max_size  Maximum side of an image, a multiple of 4; must hold each chart with its gutters.
/// @return          Sizes of the images, multiples of 4.
std::vector<Imath::V2i> pack_charts(std::vector<LightmapChart>& charts, int gutter, int max_size);

}  // namespace interflect::inline detail
