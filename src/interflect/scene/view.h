#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Fault of a view, in words without its name; empty if valid. Valid: eye, look-at and up are finite; eye and look-at
/// are within farthest_coordinate (limits.h) and far enough apart to define a direction; `up` is non-zero and not along
/// it; fov is in (0, 180); extent is in [0, farthest_coordinate].
std::string view_fault(const View& view);

/// The view with this name. @throws InputError that lists the available views.
const View& find_view(const Scene& scene, const std::string& name);

/// Default view: from just inside an upper corner of the scene's bounding box (core_bounds) towards its middle; `up` is
/// the z axis.
View overview(const Scene& scene);

/// Unnamed orthographic view of a section: the part of the scene beyond a plane. Shows the whole scene with a margin,
/// with the middle of its bounding box (core_bounds) at the centre. `up` is the z axis, or the y axis for a view along
/// z.
/// @param point      On the plane [m], in world coordinates.
/// @param direction  View direction, perpendicular to the plane; not 0.
/// @param aspect     Width over height of the picture.
View cut_view(const Scene& scene, const Imath::V3d& point, const Imath::V3d& direction, float aspect);

}  // namespace interflect::inline detail
