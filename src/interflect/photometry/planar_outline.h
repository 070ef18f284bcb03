#pragma once

#include <ImathBox.h>

#include <vector>

#include "interflect/geometry/polygons/planar_polygon.h"
#include "interflect/measure.h"

namespace interflect::detail {

/// Faces in a two-dimensional frame of world coordinates [m].
struct PlanarOutline {
    Imath::V3d origin{0, 0, 0};                  ///< On the plane.
    Imath::V3d u{1, 0, 0}, v{0, 1, 0};           ///< Unit vectors; u x v is the normal.
    std::vector<std::vector<Imath::V2d>> faces;  ///< Convex, counter-clockwise.
    Imath::Box2d box;

    Imath::V3d point(const Imath::V2d& p) const { return origin + u * p.x + v * p.y; }
    /// Includes borders.
    bool holds(const Imath::V2d& p) const;
    /// Border of the union of all faces, including holes. O(edges^2).
    std::vector<PlanarSegment> border() const;
};

/// Aligns axes with the smallest enclosing rectangle: u near x, v near z unless the plane is horizontal.
PlanarOutline outline_of(const Scene& scene, const PlanarArea& area);

double distance(const Imath::V2d& p, const PlanarSegment& s);

}  // namespace interflect::detail
