#pragma once

#include <ImathBox.h>

#include <vector>

#include "interflect/geometry/polygons/planar_polygon.h"
#include "interflect/measure.h"

namespace interflect::detail {

/// Faces of an area in two-dimensional coordinates of their plane [m].
struct PlanarOutline {
    Imath::V3d origin{0, 0, 0};                  ///< Point of the plane in world coordinates [m].
    Imath::V3d u{1, 0, 0}, v{0, 1, 0};           ///< Unit vectors in the plane; u x v is the normal.
    std::vector<std::vector<Imath::V2d>> faces;  ///< Convex and counter-clockwise.
    Imath::Box2d box;                            ///< Bounds of all faces.

    Imath::V3d point(const Imath::V2d& p) const { return origin + u * p.x + v * p.y; }
    /// Returns whether a point is on a face or its border.
    bool holds(const Imath::V2d& p) const;
    /// Returns the border of the union of all faces, including holes. Cost: O(edges^2).
    std::vector<PlanarSegment> border() const;
};

/// Returns the outline of an area. Its axes are aligned with the smallest enclosing rectangle: u is near x, and v is
/// near z unless the plane is horizontal.
PlanarOutline outline_of(const Scene& scene, const PlanarArea& area);

double distance(const Imath::V2d& p, const PlanarSegment& s);

}  // namespace interflect::detail
