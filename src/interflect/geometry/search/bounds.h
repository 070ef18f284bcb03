#pragma once

#include <ImathBox.h>

#include <cmath>
#include <cstddef>

#include "interflect/scene.h"

namespace interflect::detail {

inline Imath::Box3f widened(Imath::Box3f box, float margin) {
    box.min -= V3f(margin);
    box.max += V3f(margin);
    return box;
}

inline Imath::Box3f bounds_of(const Scene& scene, const Patch& patch) {
    Imath::Box3f box;
    for (int i = 0; i < patch.vertex_count(); ++i)
        box.extendBy(scene.vertices[patch.vertices[static_cast<std::size_t>(i)]]);
    return box;
}

/// Whether a part of a box is within `distance` [m] of a plane.
/// @param height  Signed distance from the plane (V3d -> [m]).
template <class Height>
bool meets_plane(const Imath::Box3f& box, const Imath::V3d& normal, const Height& height, double distance) {
    const Imath::V3d centre = (Imath::V3d(box.min) + Imath::V3d(box.max)) * 0.5, half = Imath::V3d(box.max) - centre;
    const double reach = std::abs(normal.x) * half.x + std::abs(normal.y) * half.y + std::abs(normal.z) * half.z;
    return std::abs(height(centre)) <= reach + distance;
}

}  // namespace interflect::detail
