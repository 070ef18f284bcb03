#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::detail {

struct UpAxis {
    const char* axis;      ///< "x", "-x", "y", ...
    const char* evidence;  ///< "views": nearly certain; "light": a guess.
};

/// Returns the views' common up axis, or opposite to most emitted light, since most lamps hang.
std::optional<UpAxis> find_up_axis(const Scene& scene);

/// Returns a probable up axis other than z by two of three criteria: light, objects on one floor, low extent. Null if
/// unknown or the views agree.
const char* find_other_up_axis(const Scene& scene);

}  // namespace interflect::detail
