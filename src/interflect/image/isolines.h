#pragma once

#include <span>

#include "interflect/image.h"
#include "interflect/image/false_colour.h"

namespace interflect::detail {

/// Draws anti-aliased isolines, white on the dark part of the scale and black on the bright part. Labels long lines and
/// omits short ones as noise. Smooths the quantity over about a pixel; lines end at its jumps.
/// @param picture  The quantity in false colours.
/// @param values   The quantity in the first channel; 0 replaces values that are not finite.
/// @param levels   In any order; each costs a pass over the picture.
/// @throws InputError if the sizes differ.
Image with_isolines(const Image& picture, const Image& values, std::span<const float> levels, const ColourScale& scale);

}  // namespace interflect::detail
