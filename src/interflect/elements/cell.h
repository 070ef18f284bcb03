#pragma once

#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

/// Square or triangle in the parameter domain of a patch: local (s, t) maps to (u + size s, v + size t). A triangle's
/// central child has a `size` of opposite sign.
struct Cell {
    float u = 0, v = 0, size = 1;

    Parameters at(float s, float t) const { return {u + size * s, v + size * t}; }
    Parameters centre(bool triangle) const { return triangle ? at(1.0f / 3, 1.0f / 3) : at(0.5f, 0.5f); }

    /// Square: k = 2 (upper half in v) + (upper half in u). Triangle: child k < 3 contains corner k; 3 is central.
    Cell child(unsigned k, bool triangle) const {
        const float half = 0.5f * size;
        const bool central = triangle & (k == 3);
        return {u + half * static_cast<float>(k & 1u), v + half * static_cast<float>(k >> 1), central ? -half : half};
    }

    unsigned child_at(Parameters p, bool triangle) const {
        const float per_size = 1 / size;  // exact, because the size is a power of two
        const float s = (p.u - u) * per_size, t = (p.v - v) * per_size;
        const bool right = s >= 0.5f, upper = t >= 0.5f, central = triangle & !right & !upper & (s + t >= 0.5f);
        // No child of a triangle is both right and upper.
        const unsigned k = static_cast<unsigned>(right) | static_cast<unsigned>(upper & !(triangle & right)) << 1;
        return central ? 3 : k;
    }
};

}  // namespace interflect::detail
