// Unlike stb, libspng and libjpeg-turbo are robust against hostile files.
#include "interflect/image/codecs/stored_image.h"

#include <fmt/format.h>
#include <spng.h>
#include <turbojpeg.h>

#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail {

namespace {

constexpr std::size_t max_chunk_bytes = std::size_t{1} << 24;  // limit for unused text and profiles

struct FreePng {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
struct FreeJpeg {
    void operator()(void* handle) const { tjDestroy(handle); }
};

void require_png(int error) {
    if (error == SPNG_OK) return;
    if (error == SPNG_IO_EOF || error == SPNG_EOF) throw std::runtime_error("it ends too early");
    throw std::runtime_error(fmt::format("it is no usable PNG ({})", spng_strerror(error)));
}

StoredImage decode_jpeg(std::string_view bytes, std::int64_t max_pixels) {
    const std::unique_ptr<void, FreeJpeg> decoder(tjInitDecompress());
    if (!decoder) throw std::runtime_error("no JPEG decoder can be made: out of memory");
    const auto require = [&](int status) {
        if (status != 0)
            throw std::runtime_error(fmt::format("it is no usable JPEG ({})", tjGetErrorStr2(decoder.get())));
    };
    if (bytes.size() > std::numeric_limits<unsigned long>::max()) throw std::runtime_error("it is too large");
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    StoredImage image;
    int subsampling = 0, colour_space = 0;
    require(tjDecompressHeader3(decoder.get(), data, bytes.size(), &image.width, &image.height, &subsampling,
                                &colour_space));
    codecs::require_allowed_size(image.width, image.height, max_pixels);
    std::vector<std::uint8_t> narrow(image.pixel_count() * StoredImage::channels);
    // TJFLAG_LIMITSCANS rejects progressive files that would take hours.
    require(tjDecompress2(decoder.get(), data, bytes.size(), narrow.data(), image.width, 0, image.height, TJPF_RGBA,
                          TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS));
    image.values.reserve(narrow.size());
    for (const std::uint8_t value : narrow) image.values.push_back(static_cast<std::uint16_t>(value * (65535 / 255)));
    return image;
}

}  // namespace

StoredImage decode_stored_png(std::string_view bytes, std::int64_t max_pixels) {
    const std::unique_ptr<spng_ctx, FreePng> context(spng_ctx_new(0));
    if (!context) throw std::runtime_error("no PNG decoder can be made: out of memory");
    require_png(spng_set_chunk_limits(context.get(), max_chunk_bytes, max_chunk_bytes));
    require_png(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()));
    spng_ihdr header{};
    require_png(spng_get_ihdr(context.get(), &header));
    codecs::require_allowed_size(header.width, header.height, max_pixels);
    StoredImage image;
    image.width = static_cast<int>(header.width);
    image.height = static_cast<int>(header.height);
    image.values.resize(image.pixel_count() * StoredImage::channels);
    require_png(spng_decode_image(context.get(), image.values.data(), image.values.size() * sizeof(std::uint16_t),
                                  SPNG_FMT_RGBA16, SPNG_DECODE_TRNS));
    require_png(spng_decode_chunks(context.get()));
    constexpr std::string_view last_chunk = "IEND\xae\x42\x60\x82";  // libspng does not check its checksum
    if (bytes.rfind(last_chunk) == bytes.npos) throw std::runtime_error("it ends too early");
    return image;
}

StoredImage decode_stored_image(std::string_view bytes, std::int64_t max_pixels) {
    if (bytes.starts_with("\x89PNG")) return decode_stored_png(bytes, max_pixels);
    if (bytes.starts_with("\xff\xd8")) return decode_jpeg(bytes, max_pixels);
    throw std::runtime_error("it begins neither as a PNG nor as a JPEG does");
}

}  // namespace interflect::detail
