#pragma once

#include <span>

#include "interflect/image.h"
#include "interflect/image/plots/false_colour.h"

namespace interflect::detail {

/// Anti-aliased; labels long lines, omits short ones, and ends lines at jumps.
/// @param picture  In false colours.
/// @param values   In the first channel; 0 replaces non-finite values.
/// @throws InputError if the sizes differ.
Image with_isolines(const Image& picture, const Image& values, std::span<const float> levels, const ColourScale& scale);

}  // namespace interflect::detail
