#pragma once

#include <string>
#include <vector>

#include "interflect/image.h"
#include "interflect/image/false_colour.h"

namespace interflect::detail {

/// Adds a legend below a picture: the title and a strip of the colours with round values.
/// @param picture  Tone-mapped, linear Rec. 709 in [0, 1].
/// @param title    Printable ASCII: a quantity with its unit.
/// @return         Same width, legend_height() higher. Parts without room are cut off: see legend_fits().
/// @throws InputError for more than most_image_pixels or an invalid title or scale.
Image with_legend(const Image& picture, const ColourScale& scale, const std::string& title);

/// Returns the height for a picture of this width [pixels]; text grows with the picture.
int legend_height(int width);

/// Whether a legend takes at most half of a picture of this size [pixels] and is not cut off.
/// @throws InputError for a title that is not printable ASCII.
bool legend_fits(int width, int height, const std::string& title);

/// Returns the largest set of up to `most` (>= 3) round values on a scale, ascending: 1, 2, 5 times powers of ten, or
/// multiples of such a number.
/// @throws InputError if `most` < 3 or the scale is invalid.
std::vector<float> round_values(const ColourScale& scale, int most);

}  // namespace interflect::detail
