#include "interflect/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <stdexcept>

#include "interflect/base/files/input_file.h"
#include "interflect/core.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"
#include "interflect/image/codecs/stored_image.h"
#include "interflect/image/files/pending_image.h"
#include "interflect/image/files/photograph.h"

namespace interflect {

using namespace detail;

namespace fs = std::filesystem;

namespace {

struct KnownExtension {
    const char* extension;
    ImageFormat format;
};
constexpr std::array<KnownExtension, 5> known_extensions = {{{".png", ImageFormat::png},
                                                             {".jpg", ImageFormat::jpeg},
                                                             {".jpeg", ImageFormat::jpeg},
                                                             {".exr", ImageFormat::exr},
                                                             {".hdr", ImageFormat::hdr}}};

std::string encode(ImageFormat format, const Image& image, const ImageMetadata& metadata,
                   std::span<const ImageLayer> layers) {
    switch (format) {
        case ImageFormat::png:
            return codecs::encode_png(image);
        case ImageFormat::jpeg:
            return codecs::encode_jpeg(image);
        case ImageFormat::hdr:
            return codecs::encode_radiance(image);
        case ImageFormat::exr:
            break;
    }
    return codecs::encode_exr(image, metadata, layers);
}

Image read_as(ImageFormat format, const fs::path& path, std::int64_t max_pixels) {
    switch (format) {
        case ImageFormat::png:
            return codecs::decode_png(read_bytes(path, max_image_bytes(max_pixels)), max_pixels);
        case ImageFormat::jpeg:
            throw std::runtime_error("JPEG loses detail and is only written, expected .png .exr .hdr");
        case ImageFormat::hdr:
            return codecs::decode_radiance(read_bytes(path, max_image_bytes(max_pixels)), max_pixels);
        case ImageFormat::exr:
            break;
    }
    return codecs::read_exr(path, max_pixels);
}

/// Calls read(format, path). Errors name the file.
template <class Read>
auto read_with(const fs::path& path, const Read& read) {
    const ImageFormat format = require_image_format(path);
    require_regular_file(path);
    try {
        return read(format, path);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& fault) {
        throw InputError(path, 0, fmt::format("cannot read this image: {}", fault.what()));
    }
}

}  // namespace

void codecs::require_allowed_size(std::int64_t width, std::int64_t height, std::int64_t max_pixels) {
    if (width < 1 || height < 1 || width > max_pixels / height)
        throw std::runtime_error(
            fmt::format("claims to have {} x {} pixels, expected 1 to {} in all", width, height, max_pixels));
}

ImageFormat require_image_format(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::string expected;
    for (const auto& known : known_extensions) {
        if (extension == known.extension) return known.format;
        expected += std::string(" ") + known.extension;
    }
    throw InputError(path, 0,
                     fmt::format("no image format has the extension '{}', expected one of{}", extension, expected));
}

void write_image(const fs::path& path, const Image& image, const ImageMetadata& metadata,
                 std::span<const ImageLayer> layers) {
    const ImageFormat format = require_image_format(path);
    require_pixels(image);
    detail::write_file(path, encode(format, image, metadata, layers));
}

void detail::write_image(PendingFile& file, const Image& image, const ImageMetadata& metadata,
                         std::span<const ImageLayer> layers) {
    const ImageFormat format = require_image_format(file.final_path());
    require_pixels(image);
    file.write(encode(format, image, metadata, layers));
    file.commit();
}

Image read_image(const fs::path& path, std::int64_t max_pixels) {
    return read_with(path, [=](ImageFormat format, const fs::path& file) { return read_as(format, file, max_pixels); });
}

Image detail::read_photograph(const fs::path& path, std::int64_t max_pixels) {
    return read_with(path, [=](ImageFormat format, const fs::path& file) {
        if (format != ImageFormat::jpeg) return read_as(format, file, max_pixels);
        return codecs::decode_jpeg(read_bytes(file, max_image_bytes(max_pixels)), max_pixels);
    });
}

std::optional<float> read_field_of_view(const fs::path& path) {
    return read_with(path, [](ImageFormat format, const fs::path& file) {
        return format == ImageFormat::exr ? codecs::read_exr_field_of_view(file) : std::nullopt;
    });
}

std::string encode_png(const Image& image) {
    require_pixels(image);
    return codecs::encode_png(image);
}

bool can_hold(ImageFormat format, int width, int height) {
    return format != ImageFormat::png || codecs::png_bytes(width, height) <= codecs::max_png_bytes;
}

std::array<std::uint8_t, 3> srgb_bytes(const Rgb& linear) {
    return {srgb_byte(linear.x), srgb_byte(linear.y), srgb_byte(linear.z)};
}

}  // namespace interflect
