#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/exports/charts/charts.h"
#include "interflect/exports/lightmap/baked_light.h"

namespace interflect::detail {

/// Point of a patch whose light a texel shows: of all points of a chart's patches, the nearest to the texel's centre.
struct TexelPlace : BakedPoint {
    bool is_inside = false;     ///< Whether the centre is on the patch.
    bool is_evaluated = false;  ///< Whether light is computed for this texel. Other texels copy it from a neighbour.
};

/// Returns the places of the texels of a chart and its gutter, row by row. Texels are evaluated if their centres are
/// less than a texel from a patch, because bilinear interpolation on the patch reads them.
std::vector<TexelPlace> places_of(const LightmapChart& chart, int gutter);

/// Result of copied_texels() if no texel is evaluated.
inline constexpr auto no_texel = static_cast<std::size_t>(-1);

/// Returns, for each texel, the index of the evaluated texel whose light it shows. Evaluated texels show their own
/// light. A flood fill assigns the other texels; if no texel is evaluated, all entries are `no_texel`.
/// @param places   Texels of a rectangle, row by row.
/// @param columns  Width of the rectangle.
std::vector<std::size_t> copied_texels(std::span<const TexelPlace> places, std::size_t columns);

}  // namespace interflect::detail
