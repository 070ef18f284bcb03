#include <fmt/format.h>
#include <libdeflate.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "interflect/core.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"
#include "interflect/image/codecs/stored_image.h"

namespace interflect::detail::codecs {

/// Compresses the rows of a PNG in place of stb's function, which is slower and makes larger files.
/// @return  Zlib stream, to be freed by free(), or null without memory.
static unsigned char* zlib_compressed(unsigned char* bytes, int size, int* compressed_size, int /*quality*/) {
    constexpr int level = 6;  // zlib's default
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(level), libdeflate_free_compressor);
    if (!compressor) return nullptr;
    const auto bytes_in = static_cast<std::size_t>(size);
    const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), bytes_in);
    auto* compressed = static_cast<unsigned char*>(std::malloc(most));
    if (!compressed) return nullptr;
    *compressed_size = static_cast<int>(libdeflate_zlib_compress(compressor.get(), bytes, bytes_in, compressed, most));
    return compressed;
}

}  // namespace interflect::detail::codecs

#define STBIW_ZLIB_COMPRESS interflect::detail::codecs::zlib_compressed
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace interflect::detail::codecs {

namespace {

constexpr int channels = 3;
constexpr int jpeg_quality = 95;  // no visible blocks on smooth walls

std::vector<std::uint8_t> srgb_bytes(const Image& image, std::span<const float> opacity = {}) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve((channels + 1) * image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb shown = is_finite(image.pixels[i]) ? image.pixels[i] : Rgb(1, 0, 1);
        for (int c = 0; c < channels; ++c) bytes.push_back(srgb_byte(shown[c]));
        if (!opacity.empty()) bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * opacity[i])));
    }
    return bytes;
}

Image linear_image(const StoredImage& stored) {
    Image image(stored.width, stored.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < channels; ++c) image.pixels[i][c] = srgb_decode(stored.value(i, c));
    return image;
}

void append(void* text, void* data, int size) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

std::string encode_png(const Image& image, std::span<const float> opacity) {
    const int all_channels = opacity.empty() ? channels : channels + 1;
    if (png_bytes(image.width, image.height, all_channels) > max_png_bytes)
        throw InputError(
            fmt::format("{} x {} pixels are too many for a PNG, which may have {} MiB before compression: "
                        "expected fewer, or .exr or .hdr",
                        image.width, image.height, max_png_bytes >> 20));
    std::string file;
    if (!stbi_write_png_to_func(append, &file, image.width, image.height, all_channels,
                                srgb_bytes(image, opacity).data(), all_channels * image.width))
        throw std::runtime_error("cannot encode the image as PNG: out of memory");
    return file;
}

std::string encode_jpeg(const Image& image) {
    constexpr int largest_side = 65535;
    std::string file;
    if (image.width > largest_side || image.height > largest_side ||
        !stbi_write_jpg_to_func(append, &file, image.width, image.height, channels, srgb_bytes(image).data(),
                                jpeg_quality))
        throw std::runtime_error("cannot encode the image as JPEG: a side must be 1 to 65535 pixels long");
    return file;
}

Image decode_png(std::string_view bytes, std::int64_t max_pixels) {
    return linear_image(decode_stored_png(bytes, max_pixels));
}

Image decode_jpeg(std::string_view bytes, std::int64_t max_pixels) {
    return linear_image(decode_stored_image(bytes, max_pixels));
}

}  // namespace interflect::detail::codecs
