#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace interflect::detail {

/// Pixels of a PNG or JPEG as stored, sRGB-encoded.
struct StoredImage {
    static constexpr int channels = 4;  ///< Red, green, blue and alpha; alpha is 1 by default.

    int width = 0, height = 0;
    std::vector<std::uint16_t> values;  ///< 65535 is 1; row 0 is at the top: [(y * width + x) * channels + c].

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    /// Returns a value in [0, 1]. @param channel  0 to 3.
    float value(std::size_t pixel, int channel) const {
        return static_cast<float>(values[pixel * channels + static_cast<std::size_t>(channel)]) / 65535;
    }
};

/// Decodes any kind of PNG. Checks the size before it allocates memory.
/// @throws std::runtime_error with the reason if the data is no PNG, truncated, damaged or too large.
StoredImage decode_stored_png(std::string_view bytes, std::int64_t most_pixels);

/// Decodes a PNG or JPEG by its first bytes. @throws std::runtime_error as decode_stored_png() does.
StoredImage decode_stored_image(std::string_view bytes, std::int64_t most_pixels);

}  // namespace interflect::detail
