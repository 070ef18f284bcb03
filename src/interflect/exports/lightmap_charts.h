#pragma once

#include <cstdint>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/flat_patches.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Patches laid out in a plane, and their rectangle in a lightmap. The outermost texel centres lie on the border of the
/// rectangle, so interpolation between texels is exact there.
struct LightmapChart {
    FlatPatches patches;  ///< Origin: corner of the rectangle, the centre of texel (0, 0). Axes: columns and rows [m].
    Imath::V2d size;      ///< Size of the rectangle [m].
    int columns = 2, rows = 2;
    int page = 0, left = 0, top = 0;  ///< Position of texel (0, 0) in the lightmap's images.

    Imath::V2d spacing() const { return {size.x / (columns - 1), size.y / (rows - 1)}; }  ///< Spacing of texels [m].
};

/// Makes charts of all shown patches. Uses an object's own layout (Scene::lightmap_coordinates) if it is usable.
/// Otherwise unfolds smooth surfaces into a plane (unfolded()) and splits them at discontinuities of light. The sides
/// of a gap or contact narrower than two texels then belong to different charts, so no texel mixes them.
/// @param shown  Patches that get a chart.
/// @param warnings  Receives the objects with unusable layouts; may be null.
/// Cost: O(n log n) for n patches.
std::vector<LightmapChart> make_charts(const Scene& scene, std::vector<bool> shown, const LightmapOptions& options,
                                       Warnings* warnings = nullptr);

}  // namespace interflect::inline detail
