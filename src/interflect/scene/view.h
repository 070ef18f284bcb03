#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::detail {

/// Fault of a view, in words without its name; empty if valid. Eye, look-at and up must be finite. Eye and look-at must
/// be within farthest_coordinate (limits.h) and far enough apart to define a direction. `up` must be non-zero and not
/// along it; fov in (0, 180); extent in [0, farthest_coordinate].
std::string view_fault(const View& view);

/// @throws InputError that lists the available views.
const View& find_view(const Scene& scene, const std::string& name);

/// Default view from an upper corner inside the scene's bounding box (core_bounds) to its middle; `up` is the z axis.
View overview(const Scene& scene);

/// Unnamed orthographic view of the part of a scene beyond a plane. Shows the whole scene with a margin, centred at the
/// middle of its bounding box (core_bounds). `up` is the z axis, or the y axis for a view along z.
/// @param point      On the plane [m], in world coordinates.
/// @param direction  View direction, perpendicular to the plane; not 0.
/// @param aspect     Width over height of the picture.
View cut_view(const Scene& scene, const Imath::V3d& point, const Imath::V3d& direction, float aspect);

}  // namespace interflect::detail
