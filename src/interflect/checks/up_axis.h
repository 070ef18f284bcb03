#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::detail {

/// Estimated up axis, which scene files do not specify.
struct UpAxis {
    const char* axis;      ///< "x", "-x", "y", ...
    const char* evidence;  ///< "views": nearly certain; "light": a guess.
};

/// Common up axis of the views, or the direction opposite to most emitted light, since most lamps hang.
std::optional<UpAxis> find_up_axis(const Scene& scene);

/// An axis other than z that is probably up, or null if z may be right. No view may contradict it, and two of three
/// criteria must hold: the light (find_up_axis); half of the objects stand on one floor (and fewer along z) and are not
/// thin along the axis, as pictures on a wall are; extent of at most 0.8 of the others, or 0.5 in elongated scenes.
/// Fewer than four objects are divided into connected faces.
const char* find_other_up_axis(const Scene& scene);

}  // namespace interflect::detail
