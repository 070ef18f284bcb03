#pragma once

#include <cstdint>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/flat_patches.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Patches in a plane, and their rectangle in a lightmap. Its border runs through the outermost texel centres.
struct LightmapChart {
    FlatPatches patches;  ///< From texel (0, 0) along columns and rows [m].
    Imath::V2d size;      ///< [m]
    int columns = 2, rows = 2;
    int page = 0, left = 0, top = 0;  ///< Position of texel (0, 0).

    Imath::V2d spacing() const { return {size.x / (columns - 1), size.y / (rows - 1)}; }  ///< [m]
};

/// Makes charts from kept_layouts(). Unfolds other smooth surfaces (unfolded()), split at discontinuities of light and
/// at gaps narrower than two texels.
std::vector<LightmapChart> make_charts(const Scene& scene, std::vector<bool> shown, const LightmapOptions& options,
                                       Warnings* warnings = nullptr);

}  // namespace interflect::detail
