// PNG and JPEG through stb. JPEG is written only: stb's reader of it can be made to write outside its tables.
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "interflect/image/image_codecs.h"
#include "interflect/image/srgb.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace interflect::inline detail::codecs {

namespace {

constexpr int channels = 3;
constexpr int jpeg_quality = 95;  // of 100: no blocks that the eye would see on smooth walls

/// Bytes as stb asks for them. stb takes zeros for what is missing at the end and says nothing: this notices.
struct ByteSource {
    std::string_view bytes;
    std::size_t position = 0;
    bool asked_too_far = false;

    static int read(void* user, char* data, int size) {
        auto& source = *static_cast<ByteSource*>(user);
        const std::size_t count = source.bytes.substr(source.position, static_cast<std::size_t>(size)).copy(data, size);
        source.position += count;
        source.asked_too_far |= count == 0 && size > 0;
        return static_cast<int>(count);
    }
    static void skip(void* user, int count) {
        auto& source = *static_cast<ByteSource*>(user);
        const auto target = static_cast<std::int64_t>(source.position) + count;
        source.asked_too_far |= target > static_cast<std::int64_t>(source.bytes.size());
        source.position = static_cast<std::size_t>(
            std::clamp<std::int64_t>(target, 0, static_cast<std::int64_t>(source.bytes.size())));
    }
    static int at_end(void* user) {
        const auto& source = *static_cast<ByteSource*>(user);
        return source.position >= source.bytes.size();
    }
};

constexpr stbi_io_callbacks callbacks = {ByteSource::read, ByteSource::skip, ByteSource::at_end};

struct Free {
    void operator()(stbi_us* values) const { stbi_image_free(values); }
};

std::vector<std::uint8_t> srgb_bytes(const Image& image) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(channels * image.pixels.size());
    for (const Rgb& pixel : image.pixels) {
        const Rgb shown = is_finite(pixel) ? pixel : Rgb(1, 0, 1);
        for (int c = 0; c < channels; ++c) bytes.push_back(srgb_byte(shown[c]));
    }
    return bytes;
}

void append(void* text, void* data, int size) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

std::string encode_png(const Image& image) {
    std::string file;
    if (!stbi_write_png_to_func(append, &file, image.width, image.height, channels, srgb_bytes(image).data(),
                                channels * image.width))
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

Image decode_png(std::string_view bytes, std::int64_t most_pixels) {
    int width = 0, height = 0, file_channels = 0;
    ByteSource header{bytes};
    if (!stbi_info_from_callbacks(&callbacks, &header, &width, &height, &file_channels))
        throw std::runtime_error(std::string("it is no PNG of a usable size (") + stbi_failure_reason() + ")");
    require_allowed_size(width, height, most_pixels);

    // 8 bit files come as exact multiples of 65535 / 255.
    ByteSource source{bytes};
    const std::unique_ptr<stbi_us, Free> values(
        stbi_load_16_from_callbacks(&callbacks, &source, &width, &height, &file_channels, channels));
    if (source.asked_too_far) throw std::runtime_error("it ends too early");
    if (!values) throw std::runtime_error(stbi_failure_reason());
    Image image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < channels; ++c)
            image.pixels[i][c] = srgb_decode(static_cast<float>(values.get()[channels * i + c]) / 65535);
    return image;
}

}  // namespace interflect::inline detail::codecs
