#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Estimated up axis, which scene files do not specify.
struct UpAxis {
    const char* axis;      ///< "x", "-x", "y", ...
    const char* evidence;  ///< "views": nearly certain; "light": a guess.
};

/// The common up axis of the views; otherwise opposite to the direction of most emitted light, since most lamps hang.
std::optional<UpAxis> find_up_axis(const Scene& scene);

/// An axis other than z that is probably up, or null if z may be right. No view may contradict it, and two of three
/// criteria must agree: the light (find_up_axis); half of the objects stand on one floor (and fewer along z); the
/// extent along the axis is at most 0.8 of the other extents. Fewer than four objects are divided into connected faces.
const char* find_other_up_axis(const Scene& scene);

}  // namespace interflect::inline detail
