#pragma once

#include <string>
#include <vector>

#include "interflect/image.h"
#include "interflect/image/plots/false_colour.h"

namespace interflect::detail {

/// Adds a title and a colour strip below a picture; clips parts without room.
/// @param picture  Tone-mapped, linear Rec. 709 in [0, 1].
/// @param title    Printable ASCII.
/// @throws InputError for more than max_image_pixels or an invalid title or scale.
Image with_legend(const Image& picture, const ColourScale& scale, const std::string& title);

/// [pixels]
int legend_height(int width);

/// Whether the whole legend takes at most half the picture. @throws InputError for an invalid title.
bool legend_fits(int width, int height, const std::string& title);

/// Returns at most `most` values, ascending: 1, 2, 5 times powers of ten, or multiples of one.
/// @throws InputError if `most` < 3 or the scale is invalid.
std::vector<float> round_values(const ColourScale& scale, int most);

}  // namespace interflect::detail
