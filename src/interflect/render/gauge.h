#pragma once

#include <cmath>

#include "interflect/colour.h"

namespace interflect::inline detail {

/// What irradiance is measured with: a small plane, or a surface whose normals are spread evenly over an arc, such as a
/// cylinder's. Its irradiance is then the mean over them.
struct Gauge {
    V3f position{0, 0, 0};  // relative to the scene's origin [m]
    V3f normal{0, 0, 1};    // in the middle of the arc
    V3f tangent{0, 0, 0};   // at a right angle to it, in the plane of the arc; both of unit length
    float half_arc = 0;     // [rad]
    float offset = 0;       // above the position, where rays start [m]

    /// @param u  In [0, 1].
    V3f normal_at(float u) const {
        const float angle = (2 * u - 1) * half_arc;
        return normal * std::cos(angle) + tangent * std::sin(angle);
    }
};

}  // namespace interflect::inline detail
