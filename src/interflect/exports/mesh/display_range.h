#pragma once

#include <algorithm>

#include "interflect/core.h"

namespace interflect::detail {

/// Scales colours to channels of at most 1, because clamping would shift chromaticity.
inline Rgb within_display_range(const Rgb& colour) { return colour / std::max(1.0f, largest_channel(colour)); }

}  // namespace interflect::detail
