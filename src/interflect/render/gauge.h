#pragma once

#include <cmath>

#include "interflect/core.h"

namespace interflect::detail {

/// Receiver of irradiance: a small plane, or a surface with normals spread evenly over an arc, such as a cylinder. The
/// irradiance is the mean over the normals.
struct Gauge {
    V3f position{0, 0, 0};  // relative to the scene's origin [m]
    V3f normal{0, 0, 1};    // at the middle of the arc
    V3f tangent{0, 0, 0};   // perpendicular to it, in the plane of the arc; both have unit length
    float half_arc = 0;     // [rad]
    float offset = 0;       // of ray origins above the position [m]

    /// @param u  In [0, 1].
    V3f normal_at(float u) const {
        const float angle = (2 * u - 1) * half_arc;
        return normal * std::cos(angle) + tangent * std::sin(angle);
    }
};

}  // namespace interflect::detail
