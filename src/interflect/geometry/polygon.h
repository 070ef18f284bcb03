#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Result of add_polygon().
enum class PolygonResult {
    added,          ///< At least one patch was added.
    degenerate,     ///< No patch was added: the polygon is no wider than the rounding of its vertices.
    self_crossing,  ///< No patch was added: the outline crosses itself and the areas cancel, which leaves the front
                    ///< undefined.
};

/// Adds a polygon as given in a file to `scene`. Triangles and convex planar quadrilaterals (planarity.h) become one
/// patch. Other polygons (concave, more than four vertices, with holes, self-intersecting, warped) are triangulated.
/// Patches keep the vertex order, so their front is the polygon's front. In a two-sided polygon each patch is followed
/// by its other side, which starts at the same vertex in reverse order.
///
/// Successive vertices at one position are merged. A triangle is degenerate, and omitted, if its height is below four
/// roundings of its largest coordinate in single precision, because its normal would be noise. No other length is
/// involved, so a polygon may be 0.1 mm or 10 km wide.
///
/// @param loops      Indices into scene.vertices. The first loop is the outline, counter-clockwise seen from the front;
///                   it may touch itself along a seam to a hole. The other loops are holes in either direction. If
///                   loops cross, a point is inside if it is inside an odd number of loops, and the crossings become
///                   new vertices of `scene` with interpolated texture and lightmap coordinates. Otherwise no vertex is
///                   added.
/// @param two_sided  Whether each patch gets its other_side.
PolygonResult add_polygon(Scene& scene, std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material,
                          std::uint32_t object, bool two_sided);

}  // namespace interflect::inline detail
