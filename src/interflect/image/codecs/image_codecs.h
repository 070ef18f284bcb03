#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "interflect/image.h"

/// Decoders throw std::runtime_error without the file name.
namespace interflect::detail::codecs {

/// @throws std::runtime_error unless 1 <= width * height <= max_pixels.
void require_allowed_size(std::int64_t width, std::int64_t height, std::int64_t max_pixels);

/// Returns the size of a PNG before compression [bytes]. stb counts the bytes as int and doubles its arrays.
constexpr std::int64_t png_bytes(int width, int height, int channels = 3) {
    return (std::int64_t{channels} * width + 1) * height;
}
inline constexpr std::int64_t max_png_bytes = std::int64_t{1} << 30;

/// @param opacity  Per pixel, in [0, 1]; empty for no alpha.
std::string encode_png(const Image& image, std::span<const float> opacity = {});
std::string encode_jpeg(const Image& image);
Image decode_png(std::string_view bytes, std::int64_t max_pixels);
Image decode_jpeg(std::string_view bytes, std::int64_t max_pixels);

std::string encode_radiance(const Image& image);
Image decode_radiance(std::string_view bytes, std::int64_t max_pixels);

/// @throws InputError for layers of another size.
std::string encode_exr(const Image& image, const ImageMetadata& metadata, std::span<const ImageLayer> layers);
Image read_exr(const std::filesystem::path& path, std::int64_t max_pixels);
std::optional<float> read_exr_field_of_view(const std::filesystem::path& path);

}  // namespace interflect::detail::codecs
