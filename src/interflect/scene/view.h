#pragma once

#include <string>

#include "interflect/scene/scene.h"

namespace interflect {

/// The view of that name. @throws InputError that lists the views there are.
const View& find_view(const Scene& scene, const std::string& name);

/// A view for a scene that names none: from high up in a corner of its bounding box (core_bounds), just inside, towards
/// its middle; `up` is the z axis.
View overview(const Scene& scene);

}  // namespace interflect
