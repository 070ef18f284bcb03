#pragma once

#include <ImathBox.h>

#include <vector>

#include "interflect/geometry/planar_polygon.h"
#include "interflect/measure.h"

namespace interflect::detail {

/// Faces of a planar area in a two-dimensional frame in world coordinates [m].
struct PlanarOutline {
    Imath::V3d origin{0, 0, 0};                  ///< Origin of the frame, on the plane.
    Imath::V3d u{1, 0, 0}, v{0, 1, 0};           ///< Axes of unit length; u x v is the normal.
    std::vector<std::vector<Imath::V2d>> faces;  ///< Convex, counter-clockwise.
    Imath::Box2d box;

    Imath::V3d point(const Imath::V2d& p) const { return origin + u * p.x + v * p.y; }
    /// Whether a point is in or on a face.
    bool holds(const Imath::V2d& p) const;
    /// Returns the edges without a neighbouring face: outlines of the area and of its holes. O(edges^2).
    std::vector<PlanarSegment> border() const;
};

/// Aligns the axes with the smallest rectangle around the faces: u as close to x as possible, and v to z in a plane
/// that is not horizontal.
PlanarOutline outline_of(const Scene& scene, const PlanarArea& area);

double distance(const Imath::V2d& p, const PlanarSegment& s);

}  // namespace interflect::detail
