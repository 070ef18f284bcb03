#pragma once

#include <span>

#include "interflect/image.h"
#include "interflect/image/false_colour.h"

namespace interflect::inline detail {

/// The picture with lines along which a quantity has certain values, anti-aliased, with those values written on the
/// longer ones. They follow the quantity smoothed over about a pixel, and end where it jumps, at the edges of things
/// and of sharp shadows. Lines shorter than a few letters are left out: these are noise. Lines are white where the
/// scale is dark and black where it is bright.
/// @param picture  The quantity in false colours.
/// @param values   The quantity: the first channel, of the same size. Pixels that are not finite count as 0.
/// @param levels   The values to draw, in any order. Each costs a pass over the picture.
/// @throws InputError where the sizes differ.
Image with_isolines(const Image& picture, const Image& values, std::span<const float> levels, const ColourScale& scale);

}  // namespace interflect::inline detail
