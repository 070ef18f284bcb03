#pragma once

#include <cstdint>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/flat_patches.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Patches laid out in a plane, and their rectangle in a lightmap. Outermost texel centres lie on the rectangle's
/// border, so interpolation is exact there.
struct LightmapChart {
    FlatPatches patches;  ///< Coordinates along columns and rows from texel (0, 0) [m].
    Imath::V2d size;      ///< Size of the rectangle [m].
    int columns = 2, rows = 2;
    int page = 0, left = 0, top = 0;  ///< Position of texel (0, 0).

    Imath::V2d spacing() const { return {size.x / (columns - 1), size.y / (rows - 1)}; }  ///< [m]
};

/// Makes charts from an object's own layout (Scene::lightmap_coordinates) if usable. Otherwise unfolds smooth surfaces
/// (unfolded()) and splits them at discontinuities of light. It separates the sides of gaps and contacts narrower than
/// two texels, so no texel mixes them.
/// @param shown  Patches that get a chart.
/// @param warnings  Receives the objects with unusable layouts; may be null.
/// Cost: O(n log n) for n patches.
std::vector<LightmapChart> make_charts(const Scene& scene, std::vector<bool> shown, const LightmapOptions& options,
                                       Warnings* warnings = nullptr);

}  // namespace interflect::detail
