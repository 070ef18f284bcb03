#pragma once

#include <ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

struct PlanarCorner {
    Imath::V2d position;          ///< Coordinates in the plane's frame [m].
    std::uint32_t vertex = none;  ///< Index in the scene; `none` for a new corner.
};

/// Convex polygon, counter-clockwise.
using PlanarPolygon = std::vector<PlanarCorner>;

struct PlanarSegment {
    Imath::V2d a, b;
    double length() const { return (b - a).length(); }
};

/// Returns twice the area [m^2].
inline double doubled_area(const PlanarPolygon& polygon) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += (polygon[i].position - polygon[0].position).cross(polygon[i + 1].position - polygon[0].position);
    return sum;
}

inline double perimeter(const PlanarPolygon& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sum += (polygon[(i + 1) % polygon.size()].position - polygon[i].position).length();
    return sum;
}

}  // namespace interflect::detail
