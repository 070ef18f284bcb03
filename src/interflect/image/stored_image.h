#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace interflect::inline detail {

/// The pixels of a PNG or JPEG as the file stores them: not decoded from sRGB.
struct StoredImage {
    static constexpr int channels = 4;  ///< Red, green, blue and alpha, which is 1 where the file has none.

    int width = 0, height = 0;
    std::vector<std::uint16_t> values;  ///< 65535 is 1; row by row, row 0 at the top: [(y * width + x) * channels + c].

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    /// In [0, 1]. @param channel  0 to 3.
    float value(std::size_t pixel, int channel) const {
        return static_cast<float>(values[pixel * channels + static_cast<std::size_t>(channel)]) / 65535;
    }
};

/// Decodes a PNG of any kind. Sizes are checked before the memory is taken.
/// @throws std::runtime_error with the reason alone where it is none, is cut short or damaged, or has more pixels.
StoredImage decode_stored_png(std::string_view bytes, std::int64_t most_pixels);

/// Decodes a PNG or a JPEG, by what it begins with. @throws std::runtime_error likewise.
StoredImage decode_stored_image(std::string_view bytes, std::int64_t most_pixels);

}  // namespace interflect::inline detail
