#pragma once

#include <string>

#include "interflect/image.h"

namespace interflect::detail {

inline const Rgb ink(0.8f, 0.8f, 0.8f), paper(0.01f, 0.01f, 0.01f);

/// Returns the side of a dot, the unit of the lettering [pixels].
int dot_size(int picture_width);

/// Fills a rectangle [pixels], clipped to the image. Excludes the column `right` and the row `bottom`.
void fill(Image& image, int left, int top, int right, int bottom, const Rgb& colour);

/// Height of capitals and digits [dots].
inline constexpr int text_height = 7;
/// Returns the width of a text [pixels].
int text_width(std::string text, int dot);
/// Writes printable ASCII.
void write_text(Image& image, int left, int top, std::string text, int dot);

}  // namespace interflect::detail
