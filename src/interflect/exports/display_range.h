#pragma once

#include <algorithm>

#include "interflect/core.h"

namespace interflect::detail {

/// Divides a colour by its largest channel if that exceeds 1; clamping would shift its chromaticity.
inline Rgb within_display_range(const Rgb& colour) { return colour / std::max(1.0f, largest_channel(colour)); }

}  // namespace interflect::detail
