#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "interflect/core.h"
#include "interflect/indices.h"

namespace interflect::detail {

class PatchGeometry;

/// A white receiver at which paths start: a small plane, or the mean of planes whose normals form an arc.
struct Gauge {
    V3f position{0, 0, 0};                 // relative to the scene's origin [m]
    V3f normal{0, 0, 1};                   // unit normal at the middle of the arc
    V3f tangent{0, 0, 0};                  // unit vector in the arc's plane, perpendicular to the normal
    float half_arc = 0;                    // half angle of the arc [rad]; 0 for a plane
    float offset = 0;                      // distance of ray origins from the position, along the normal [m]
    PatchIndex patch{};                    // patch below the gauge; `none` in space
    V3f side_u{0, 0, 0}, side_v{0, 0, 0};  // parallelogram of ray starts around `position` on the patch [m]
    float inset = 0;                       // least distance of ray starts from the patch's border [m]
    bool is_filtered = false;              // whether noise of its light is filtered later

    float spacing() const { return std::max(side_u.length(), side_v.length()); }
    /// Returns a point of the parallelogram on the patch [m]. If the point is outside the patch, its offset from
    /// `position` is mirrored along one side or both. So the part of the parallelogram on the patch is covered evenly.
    /// @param u, v  In [0, 1].
    V3f point_on(const PatchGeometry& geometry, float u, float v) const;
    /// @param u  In [0, 1].
    V3f normal_at(float u) const {
        const float angle = (2 * u - 1) * half_arc;
        return normal * std::cos(angle) + tangent * std::sin(angle);
    }
};

}  // namespace interflect::detail
