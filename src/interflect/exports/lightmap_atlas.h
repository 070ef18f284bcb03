#pragma once

#include <ImathVec.h>

#include <vector>

#include "interflect/exports/lightmap_charts.h"

namespace interflect::inline detail {

/// Places charts in images, each with a gutter around it, and turns those that fit better so.
/// @param max_size  Of a side of an image, a multiple of 4; every chart fits with its gutters.
/// @return          The sizes of the images, multiples of 4.
std::vector<Imath::V2i> pack_charts(std::vector<LightmapChart>& charts, int gutter, int max_size);

}  // namespace interflect::inline detail
