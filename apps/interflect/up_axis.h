#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::command {

/// Which way is up, where something tells: no scene file says so.
struct UpAxis {
    const char* axis;      ///< "x", "-x", "y", ...
    const char* evidence;  ///< What tells: "views", which is nearly certain, or "light", which is a guess.
};

/// Up in the views if they agree; else against the way that most of the light is emitted, since most lamps hang.
std::optional<UpAxis> find_up_axis(const Scene& scene);

}  // namespace interflect::command
