#pragma once

#include <cassert>
#include <span>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns twice the area [m^2] times the unit normal.
/// @param corners  Of a triangle or a convex, nearly planar quadrilateral, counter-clockwise about the normal.
template <class T>
Imath::Vec3<T> doubled_area_vector(std::span<const Imath::Vec3<T>> corners) {
    assert(corners.size() == 3 || corners.size() == 4);
    return corners.size() == 3 ? (corners[1] - corners[0]).cross(corners[2] - corners[0])
                               : (corners[2] - corners[0]).cross(corners[3] - corners[1]);
}

}  // namespace interflect::detail
