#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns a probable up axis other than z by two of three criteria: light, objects on one floor, low extent. Null
/// without a probable axis, or if the views have a common up axis.
const char* find_other_up_axis(const Scene& scene);

}  // namespace interflect::detail
