#pragma once

#include <span>

#include "interflect/image.h"
#include "interflect/image/false_colour.h"

namespace interflect::detail {

/// Draws anti-aliased lines of constant values and labels the longer ones. Lines follow the quantity smoothed over
/// about a pixel and end where it jumps, at edges of objects and sharp shadows. Lines shorter than a few letters are
/// omitted as noise. Lines are white on the dark part of the scale and black on the bright part.
/// @param picture  The quantity in false colours.
/// @param values   The quantity in the first channel, of the same size. Pixels that are not finite count as 0.
/// @param levels   Values to draw, in any order; each costs a pass over the picture.
/// @throws InputError if the sizes differ.
Image with_isolines(const Image& picture, const Image& values, std::span<const float> levels, const ColourScale& scale);

}  // namespace interflect::detail
