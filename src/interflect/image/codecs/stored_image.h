#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace interflect::detail {

/// Decoded PNG or JPEG with sRGB-encoded pixels.
struct StoredImage {
    static constexpr int channels = 4;  ///< RGBA; alpha is 1 by default.

    int width = 0, height = 0;
    std::vector<std::uint16_t> values;  ///< 65535 is 1; [(y * width + x) * channels + c], row 0 at the top.

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    /// Returns the encoded value, in [0, 1].
    float value(std::size_t pixel, int channel) const {
        return static_cast<float>(values[pixel * channels + static_cast<std::size_t>(channel)]) / 65535;
    }
};

/// Size of the largest PNG, JPEG or HDR file with `max_pixels` pixels [bytes]: twice the largest encoding, of 8 bytes a
/// pixel, and 16 MiB of other data.
constexpr std::uintmax_t max_image_bytes(std::int64_t max_pixels) {
    return 16 * static_cast<std::uintmax_t>(max_pixels) + (std::uintmax_t{1} << 24);
}

/// @throws std::runtime_error if the data is no PNG, truncated, damaged or too large.
StoredImage decode_stored_png(std::string_view bytes, std::int64_t max_pixels);

/// @throws as decode_stored_png().
StoredImage decode_stored_image(std::string_view bytes, std::int64_t max_pixels);

}  // namespace interflect::detail
