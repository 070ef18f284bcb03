#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Result of add_polygon().
enum class PolygonResult {
    added,          ///< At least one patch was added.
    degenerate,     ///< Nothing was added: the polygon is no wider than the rounding of its vertices.
    self_crossing,  ///< Nothing was added: its outline crosses itself, and the areas cancel, so that it has no front.
};

/// Adds a polygon, as a file gives it, to `scene`: a triangle as one patch, a convex planar quadrilateral (planarity.h)
/// as one, anything else (concave, more than four vertices, with holes, self-intersecting, warped) as triangles.
/// Patches keep the order of the vertices, so their front is the polygon's; a two-sided polygon gives after each patch
/// its other side, which starts at the same vertex and goes the other way round.
///
/// Successive vertices at one position count as one. A triangle counts as having no area, and is left out, where its
/// height is below four roundings of its largest coordinate in single precision: its normal would be noise. There is no
/// other length in this, so the polygon may be a tenth of a millimetre or ten kilometres wide.
///
/// @param loops     Indices into scene.vertices. The first loop is the outline, counter-clockwise seen from the front;
///                  it may touch itself along a seam that leads to a hole and back. The others are holes, of either
///                  direction. Where loops cross, a point is inside if it is inside an odd number of times, and the
///                  crossings become new vertices of `scene`; otherwise no vertex is added. Coordinates
///                  in textures and lightmaps are interpolated there.
/// @param two_sided Whether each patch gets its other_side.
PolygonResult add_polygon(Scene& scene, std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material,
                          std::uint32_t object, bool two_sided);

}  // namespace interflect::inline detail
