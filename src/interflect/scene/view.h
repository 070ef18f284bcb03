#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// What is wrong with a view, in words without its name; empty where it shows something: eye, look-at and up are
/// finite, eye and look-at no farther out than farthest_coordinate (limits.h) and far enough apart for the direction
/// not to be rounding, `up` has a length and is not along it, fov is in (0, 180).
std::string view_fault(const View& view);

/// The view of that name. @throws InputError that lists the views there are.
const View& find_view(const Scene& scene, const std::string& name);

/// A view for a scene that names none: from high up in a corner of its bounding box (core_bounds), just inside, towards
/// its middle; `up` is the z axis.
View overview(const Scene& scene);

}  // namespace interflect::inline detail
