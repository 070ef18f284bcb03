#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/colour.h"

namespace interflect {

/// Limit for rendering and reading images, independent of file headers.
inline constexpr std::int64_t most_image_pixels = std::int64_t{1} << 28;

/// A picture: linear Rec. 709 colours in any unit, row by row, row 0 at the top.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;  ///< [y * width + x]

    Image() = default;
    /// @param fill  Initial colour of every pixel.
    Image(int image_width, int image_height, const Rgb& fill = Rgb(0, 0, 0))
        : width(image_width),
          height(image_height),
          pixels(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height), fill) {}

    Rgb& at(int x, int y) { return pixels[index(x, y)]; }
    const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// @throws InputError unless the image has pixels and their number matches width and height.
void require_pixels(const Image& image);

/// @throws InputError unless both images have pixels and the same size.
void require_same_size(const Image& image, const Image& reference);

/// Replaces every factor x factor block of pixels by its mean.
/// @throws InputError if width or height is not a multiple of `factor`, factor < 1, and as require_pixels() does.
Image box_downsample(const Image& image, int factor);

/// Number of pixels with an infinite or NaN channel.
std::int64_t count_non_finite(const Image& image);

}  // namespace interflect
