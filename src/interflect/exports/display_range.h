#pragma once

#include <algorithm>

#include "interflect/core.h"

namespace interflect::detail {

/// Scales a colour to a largest channel of at most 1. Clamping would shift its chromaticity.
inline Rgb within_display_range(const Rgb& colour) { return colour / std::max(1.0f, largest_channel(colour)); }

}  // namespace interflect::detail
