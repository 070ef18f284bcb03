#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

enum class PolygonResult {
    added,
    degenerate,     ///< Narrower than the rounding of its vertices; not added.
    self_crossing,  ///< The outline crosses itself and its areas cancel; not added.
};

/// Adds a polygon to `scene`: triangles and convex planar quadrilaterals (planarity.h) as one patch, others
/// triangulated. Patches keep the vertex order. Each back follows its front, in reverse order from the same vertex.
/// Merges consecutive vertices at one position. Omits patches below smallest_face_area, and triangles with a height
/// below four float roundings of their largest coordinate, because their normal would be noise.
/// @param loops      Indices into scene.vertices: the outline, counter-clockwise seen from the front, then holes in any
///                   direction. The outline may touch itself along a seam to a hole. Points inside an odd number of
///                   loops are inside. Crossings become new vertices with interpolated attributes.
/// @param two_sided  Adds the back of each patch.
PolygonResult add_polygon(Scene& scene, std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material,
                          std::uint32_t object, bool two_sided);

}  // namespace interflect::detail
