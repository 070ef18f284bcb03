#pragma once

#include <cmath>

#include "interflect/core.h"

namespace interflect::detail {

/// Right-handed frame of unit vectors s, t, n (Duff et al. 2017).
struct TangentFrame {
    V3f s, t;
    explicit TangentFrame(const V3f& n) {
        const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
        s = V3f(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        t = V3f(b, sign + n.y * n.y * a, -n.y);
    }
};

}  // namespace interflect::detail
