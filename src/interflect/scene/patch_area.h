#pragma once

#include <cassert>
#include <span>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// The cross product of two edges of a triangle, or of the diagonals of a convex, (nearly) planar quadrilateral: twice
/// its area [m^2] times its unit normal.
/// @param corners  3 or 4, counter-clockwise seen from where the normal points.
template <class T>
Imath::Vec3<T> doubled_area_vector(std::span<const Imath::Vec3<T>> corners) {
    assert(corners.size() == 3 || corners.size() == 4);
    return corners.size() == 3 ? (corners[1] - corners[0]).cross(corners[2] - corners[0])
                               : (corners[2] - corners[0]).cross(corners[3] - corners[1]);
}

/// Area of a patch [m^2].
float patch_area(const Scene& scene, const Patch& patch);

}  // namespace interflect::inline detail
