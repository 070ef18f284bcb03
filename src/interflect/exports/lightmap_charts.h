#pragma once

#include <cstdint>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/flat_patches.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Patches laid out in a plane, and the rectangle of a lightmap that their light is in. The outermost texels' centres
/// lie on the border of a rectangle around the patches, so that what is interpolated between texels is exact there.
struct LightmapChart {
    FlatPatches
        patches;      ///< From the corner of the rectangle, where texel (0, 0) is centred, along columns and rows [m].
    Imath::V2d size;  ///< Of the rectangle [m].
    int columns = 2, rows = 2;
    int page = 0, left = 0, top = 0;  ///< Where texel (0, 0) is in the lightmap's images.

    Imath::V2d spacing() const { return {size.x / (columns - 1), size.y / (rows - 1)}; }  ///< Of texels [m].
};

/// Charts of an object's own layout (Scene::lightmap_coordinates) where it has one that can be used, elsewhere of
/// smooth surfaces as they unfold into a plane (unfolded()), divided where light is discontinuous within them.
/// Two sides of a gap or a contact that is narrower than two texels are in different charts, so that no texel mixes
/// them; layouts are kept as they are.
/// @param shown  Which patches get a chart.
/// @param warnings  Gets which objects' layouts cannot be used; may be null.
/// Cost: O(n log n) in the number of patches n.
std::vector<LightmapChart> make_charts(const Scene& scene, std::vector<bool> shown, const LightmapOptions& options,
                                       Warnings* warnings = nullptr);

}  // namespace interflect::inline detail
