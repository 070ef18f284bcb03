#pragma once

#include <string>

#include "interflect/image.h"

namespace interflect::inline detail {

// Text and rectangles in pictures. Text is drawn with dots of a whole number of pixels.

/// Colours of what is written on pictures, and of what is below it.
inline const Rgb ink(0.8f, 0.8f, 0.8f), paper(0.01f, 0.01f, 0.01f);

/// Pixels a dot in a picture of this width [pixels]: text grows with the picture.
int dot_size(int picture_width);

/// Fills the part of a rectangle that lies in the image; right and bottom are exclusive [pixels].
void fill(Image& image, int left, int top, int right, int bottom, const Rgb& colour);

/// Of a capital letter or a digit, in dots.
inline constexpr int text_height = 7;
/// [pixels]
int text_width(std::string text, int dot);
/// Writes printable ASCII from its top left corner on.
void write_text(Image& image, int left, int top, std::string text, int dot);

}  // namespace interflect::inline detail
