#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <vector>

#include "interflect/exports/charts/charts.h"

namespace interflect::detail {

/// Packs charts into images, and rotates some of them. Returns the sizes of the images, which are multiples of 4.
/// @param max_size  Largest side, a multiple of 4; must hold each chart with gutters.
std::vector<Imath::V2i> pack_charts(std::vector<LightmapChart>& charts, int gutter, int max_size);

/// Packs charts of a group into one image. A group that is too large for an image gets fewer texels.
/// @param first  Index of the first chart of each group, ascending; a group ends where the next begins.
std::vector<Imath::V2i> pack_groups(std::vector<LightmapChart>& charts, const std::vector<std::uint32_t>& first,
                                    int gutter, int max_size);

}  // namespace interflect::detail
