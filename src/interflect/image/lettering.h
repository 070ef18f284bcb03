#pragma once

#include <string>

#include "interflect/image.h"

namespace interflect::detail {

// Text and rectangles in pictures. Dots of text are a whole number of pixels wide.

/// Colours of text and of its background.
inline const Rgb ink(0.8f, 0.8f, 0.8f), paper(0.01f, 0.01f, 0.01f);

/// Returns the pixels per dot in a picture of this width [pixels].
int dot_size(int picture_width);

/// Fills a rectangle, clipped to the image. Right and bottom are exclusive [pixels].
void fill(Image& image, int left, int top, int right, int bottom, const Rgb& colour);

/// Height of a capital letter or a digit [dots].
inline constexpr int text_height = 7;
/// [pixels]
int text_width(std::string text, int dot);
/// Writes printable ASCII from its top left corner.
void write_text(Image& image, int left, int top, std::string text, int dot);

}  // namespace interflect::detail
