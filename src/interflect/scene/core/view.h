#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::detail {

/// Describes a fault; "" if valid. Eye and look-at must be within farthest_coordinate and define a direction; `up` must
/// not be 0 or along it; fov in (0, 180); extent in [0, farthest_coordinate].
std::string view_fault(const View& view);

}  // namespace interflect::detail
