#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::detail {

/// Estimated up axis, which scene files do not specify.
struct UpAxis {
    const char* axis;      ///< "x", "-x", "y", ...
    const char* evidence;  ///< "views": nearly certain; "light": a guess.
};

/// Returns the common up axis of the views, or the direction opposite to most emitted light: most lamps hang.
std::optional<UpAxis> find_up_axis(const Scene& scene);

/// Returns a probable up axis other than z, or null, also if the views agree on one. Two of three criteria must hold:
/// light (find_up_axis()), many objects on one floor, low extent.
const char* find_other_up_axis(const Scene& scene);

}  // namespace interflect::detail
