#pragma once

#include <string>
#include <vector>

#include "interflect/image.h"
#include "interflect/image/false_colour.h"

namespace interflect::inline detail {

/// The picture with a legend below: what it shows, over a strip of the colours with round values.
/// @param picture  As a display shows it: linear Rec. 709 in [0, 1].
/// @param title    Printable ASCII: a quantity with its unit.
/// @return         As wide, and legend_height() higher. What has no room is cut off: see legend_fits().
/// @throws InputError where that has more than most_image_pixels, for another title, and for a scale whose ends are not
///         as ColourScale says.
Image with_legend(const Image& picture, const ColourScale& scale, const std::string& title);

/// Of a picture of this width [pixels]: text grows with the picture.
int legend_height(int width);

/// Whether a legend takes no more than half of a picture of this size [pixels], and no part of it is cut off.
/// @throws InputError for a title that is not printable ASCII.
bool legend_fits(int width, int height, const std::string& title);

/// Round values between the ends of a scale, ascending: the most there can be of 1, 2, 5 times powers of ten, or of
/// multiples of such a number, without being more than `most` (>= 3).
/// @throws InputError for fewer, and for a scale whose ends are not as ColourScale says.
std::vector<float> round_values(const ColourScale& scale, int most);

}  // namespace interflect::inline detail
