#pragma once

#include "interflect/geometry/patch_geometry.h"

namespace interflect::inline detail {

/// The part of a patch's parameter domain that an element covers: a square of a quadrilateral, a triangle of a
/// triangle. A local point (s, t) of the domain's own shape lies at (u + size s, v + size t); size is negative for the
/// triangles that stand on their head (each central child does, relative to its parent).
struct Cell {
    float u = 0, v = 0, size = 1;

    Parameters at(float s, float t) const { return {u + size * s, v + size * t}; }
    Parameters centre(bool triangle) const { return triangle ? at(1.0f / 3, 1.0f / 3) : at(0.5f, 0.5f); }

    /// Child k of the regular 1:4 subdivision. Quadrilateral: k = 2 (upper half in v) + (upper half in u). Triangle: k
    /// = 0, 1, 2 keep the corner at v0, v1, v2; k = 3 is the central one.
    Cell child(unsigned k, bool triangle) const {
        const float half = 0.5f * size;
        const bool central = triangle & (k == 3);
        // Products in place of branches, which nobody could predict.
        return {u + half * static_cast<float>(k & 1u), v + half * static_cast<float>(k >> 1), central ? -half : half};
    }

    /// Which child holds a point of this cell; points on a border go to one of the neighbours, always the same.
    unsigned child_at(Parameters p, bool triangle) const {
        const float per_size = 1 / size;  // exact: a power of two
        const float s = (p.u - u) * per_size, t = (p.v - v) * per_size;
        const bool right = s >= 0.5f, upper = t >= 0.5f, central = triangle & !right & !upper & (s + t >= 0.5f);
        // Bits in place of branches, which nobody could predict: of a triangle's children none is both.
        const unsigned k = static_cast<unsigned>(right) | static_cast<unsigned>(upper & !(triangle & right)) << 1;
        return central ? 3 : k;
    }
};

}  // namespace interflect::inline detail
