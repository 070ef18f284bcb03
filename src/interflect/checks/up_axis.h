#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Which way is up, where something tells: no scene file says so.
struct UpAxis {
    const char* axis;      ///< "x", "-x", "y", ...
    const char* evidence;  ///< What tells: "views", which is nearly certain, or "light", which is a guess.
};

/// Up in the views if they agree; else against the way that most of the light is emitted, since most lamps hang.
std::optional<UpAxis> find_up_axis(const Scene& scene);

/// The axis that is probably up in place of z: no view says otherwise, and two of three agree on it: the light
/// (find_up_axis), half of the objects standing on one floor (and fewer along z), and an extent along it of at most 0.8
/// of the others. Fewer than four objects are divided into connected faces. Null if z may be right.
const char* find_other_up_axis(const Scene& scene);

}  // namespace interflect::inline detail
