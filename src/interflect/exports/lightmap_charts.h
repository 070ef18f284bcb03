#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Patches in one plane, and the rectangle of a lightmap that their light is in. The outermost texels' centres lie on
/// the border of the smallest rectangle around the patches, so that what is interpolated between texels is exact there.
struct LightmapChart {
    std::vector<std::uint32_t> patches;
    Imath::V3d origin;        ///< Corner of the rectangle, where texel (0, 0) is centred [m].
    Imath::V3d across, down;  ///< Unit vectors along its columns and rows.
    Imath::V2d size;          ///< [m]
    int columns = 2, rows = 2;
    int page = 0, left = 0, top = 0;  ///< Where texel (0, 0) is in the lightmap's images.

    Imath::V2d spacing() const { return {size.x / (columns - 1), size.y / (rows - 1)}; }  ///< Of texels [m].
    /// In texels from the centre of texel (0, 0).
    Imath::V2d texel_at(const V3f& x) const {
        const Imath::V3d offset = Imath::V3d(x) - origin;
        return {offset.dot(across) / spacing().x, offset.dot(down) / spacing().y};
    }
    Imath::V3d point_at(double column, double row) const {
        return origin + across * (column * spacing().x) + down * (row * spacing().y);
    }
};

/// Charts of flat surfaces (flat_surfaces.h), divided where light is discontinuous within them. Two sides
/// of a gap or a contact that is narrower than two texels are in different charts, so that no texel mixes them.
/// @param shown  Which patches get a chart.
/// @param texels_per_metre  At least, in each direction. @param most_texels  Of a side: wider charts get fewer a metre.
/// Cost: O(n log n) in the number of patches n.
std::vector<LightmapChart> make_charts(const Scene& scene, const std::vector<bool>& shown, double texels_per_metre,
                                       int most_texels);

}  // namespace interflect::inline detail
