#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/exports/charts/charts.h"
#include "interflect/exports/lightmap/baked_light.h"

namespace interflect::detail {

/// The point of a patch that is nearest to the centre of a texel.
struct TexelPlace : BakedPoint {
    bool is_inside = false;  ///< Whether the centre is on the patch.
    bool is_near = false;    ///< Whether the centre is within a texel of the patch; bilinear interpolation needs it.
};

/// Returns the places of the texels of a chart and its gutter, row by row.
std::vector<TexelPlace> places_of(const LightmapChart& chart, int gutter);

/// Entry of copied_texels() for charts in which no texel is near a patch.
inline constexpr auto no_texel = static_cast<std::size_t>(-1);

/// Returns, for each texel, the texel near a patch whose light it copies, found by flood fill. Texels near a patch copy
/// themselves. If no texel is near a patch, all are `no_texel`.
std::vector<std::size_t> copied_texels(std::span<const TexelPlace> places, std::size_t columns);

}  // namespace interflect::detail
