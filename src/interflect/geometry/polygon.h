#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

enum class PolygonResult {
    added,
    degenerate,     ///< The polygon is no wider than the rounding of its vertices; no patch was added.
    self_crossing,  ///< The outline crosses itself and its areas cancel; no patch was added.
};

/// Adds a polygon to `scene`. Triangles and convex planar quadrilaterals (planarity.h) become one patch. Other polygons
/// (concave, more than four vertices, with holes, self-intersecting, warped) are triangulated. Patches keep the vertex
/// order and thus the front. The other side of each patch follows it, starts at the same vertex and has reverse order.
///
/// Successive vertices at one position are merged. Triangles are omitted as degenerate if their height is below four
/// roundings of their largest coordinate in single precision, because their normal would be noise. No other length
/// matters, so polygons of 0.1 mm or 10 km are valid.
///
/// @param loops      Indices into scene.vertices. First the outline, counter-clockwise seen from the front; it may
///                   touch itself along a seam to a hole. Then holes in either direction. If loops cross, points inside
///                   an odd number of loops are inside, and the crossings become new vertices of `scene` with
///                   interpolated texture and lightmap coordinates. Otherwise no vertex is added.
/// @param two_sided  Whether each patch gets its other_side.
PolygonResult add_polygon(Scene& scene, std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material,
                          std::uint32_t object, bool two_sided);

}  // namespace interflect::detail
