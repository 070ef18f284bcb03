#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// What is wrong with a view, in words without its name; empty where it shows something: eye, look-at and up are
/// finite, eye and look-at no farther out than farthest_coordinate (limits.h) and far enough apart for the direction
/// not to be rounding, `up` has a length and is not along it, fov is in (0, 180), extent in [0, farthest_coordinate].
std::string view_fault(const View& view);

/// The view of that name. @throws InputError that lists the views there are.
const View& find_view(const Scene& scene, const std::string& name);

/// A view for a scene that names none: from high up in a corner of its bounding box (core_bounds), just inside, towards
/// its middle; `up` is the z axis.
View overview(const Scene& scene);

/// An orthographic view without a name of the scene cut open: of what lies beyond a plane. It shows the whole scene
/// with a margin, the middle of its bounding box (core_bounds) in the middle of the picture. `up` is the z axis, or the
/// y axis where the view goes along z.
/// @param point      On the plane [m], in the world.
/// @param direction  Of the view, at a right angle to the plane; not 0.
/// @param aspect     Width over height of the picture.
View cut_view(const Scene& scene, const Imath::V3d& point, const Imath::V3d& direction, float aspect);

}  // namespace interflect::inline detail
