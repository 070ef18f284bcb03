#include "interflect/formats/gltf/parts/images.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/core.h"
#include "interflect/formats/build/texture_limit.h"
#include "interflect/image/codecs/srgb.h"

namespace interflect::detail {

namespace {

constexpr int repeat = 10497;  // glTF constant

/// Limit of all decoded pixels, because each texture decodes its images again.
constexpr std::uint64_t max_decoded = 32 * max_texels;

/// Returns the linear values of 16-bit sRGB values.
const std::vector<float>& decoded_srgb() {
    static const std::vector<float> table = [] {
        std::vector<float> values(1 << 16);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = srgb_decode(static_cast<float>(i) / 65535);
        return values;
    }();
    return table;
}

Rgb colour_at(const StoredImage& image, std::size_t pixel) {
    const std::vector<float>& decoded = decoded_srgb();
    const std::uint16_t* values = &image.values[pixel * StoredImage::channels];
    return {decoded[values[0]], decoded[values[1]], decoded[values[2]]};
}

/// Returns the index of the pixel of `image` at the centre of texel (x, y) of `texture`.
std::size_t pixel_at(const StoredImage& image, std::uint32_t x, std::uint32_t y, const Texture& texture) {
    const auto scaled = [](std::uint64_t i, std::uint64_t from, int to) {
        return static_cast<std::size_t>((2 * i + 1) * static_cast<std::uint64_t>(to) / (2 * from));
    };
    return scaled(y, texture.height, image.height) * static_cast<std::size_t>(image.width) +
           scaled(x, texture.width, image.width);
}

}  // namespace

GltfImages::GltfImages(GltfAsset& asset, GltfBuffers& buffers)
    : asset_(asset),
      buffers_(buffers),
      images_(asset.root().objects("images")),
      textures_(asset.root().objects("textures")),
      samplers_(asset.root().objects("samplers")) {
    std::map<std::string, std::uint32_t> first;
    for (std::uint32_t i = 0; i < images_.size(); ++i) {
        const std::string source = images_[i].has("uri")
                                       ? images_[i].text("uri")
                                       : fmt::format(" {}", images_[i].index("bufferView", buffers_.view_count()));
        first_alike_.push_back(first.try_emplace(source, i).first->second);
    }
}

std::uint32_t GltfImages::image_of_texture(std::uint32_t texture) {
    const GltfValue& owner = textures_[texture];
    const std::uint32_t image = owner.index("source", images_.size());
    for (const char* extension : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"}) {
        if (!owner.extension(extension).exists()) continue;
        if (image == none) owner.fail(fmt::format("its only image is that of {}, which is not read", extension));
        asset_.warn("texture-format", fmt::format("the PNG or JPEG is used in place of the image of {}", extension),
                    owner.place());
    }
    if (image == none) {
        asset_.warn("no-image", "a texture without an image is taken as white", owner.place());
        return none;
    }
    if (images_[image].has("uri") && asset_.is_missing(images_[image].text("uri"), images_[image])) {
        asset_.warn("missing-texture", "an image that is missing is taken as white: the factors alone are used",
                    images_[image].place());
        return none;
    }
    return first_alike_[image];
}

bool GltfImages::repeats(std::uint32_t texture) const {
    const std::uint32_t index = textures_[texture].index("sampler", samplers_.size());
    if (index == none) return true;
    const GltfValue& sampler = samplers_[index];
    return sampler.integer("wrapS", repeat) == repeat && sampler.integer("wrapT", repeat) == repeat;
}

std::string GltfImages::bytes_of(std::uint32_t image) {
    const GltfValue& owner = images_[image];
    if (owner.has("uri")) return asset_.read_uri(owner.text("uri"), owner);
    const std::uint32_t view = owner.required_index("bufferView", buffers_.view_count());
    return std::string(buffers_.view(view).bytes);
}

StoredImage GltfImages::decode(std::uint32_t image) {
    const GltfValue& owner = images_[image];
    const std::string bytes = bytes_of(image);
    try {
        StoredImage result = decode_stored_image(bytes, static_cast<std::int64_t>(max_texels));
        decoded_ += result.pixel_count();
        if (decoded_ > max_decoded)
            throw std::runtime_error(fmt::format("with it, more than {} pixels are decoded", max_decoded));
        if (static_cast<std::uint32_t>(std::max(result.width, result.height)) > max_texels_of_side)
            throw std::runtime_error(fmt::format("it has {} x {} pixels, expected 1 to {} a side", result.width,
                                                 result.height, max_texels_of_side));
        return result;
    } catch (const std::runtime_error& fault) {
        owner.fail(fmt::format("cannot read this image: {}", fault.what()));
    }
}

Texture GltfImages::make_texture(const GltfTexels& texels, bool& is_reduced) {
    // Decode the images; the first one determines the size
    StoredImage colour, metallic, coverage;
    const StoredImage* shape = nullptr;  // image that determines the size
    std::string name;
    const auto load = [&](std::uint32_t index, StoredImage& image) {
        if (index == none) return;
        image = decode(index);
        if (!shape) {
            shape = &image;
            name = images_[index].place();
        }
    };
    load(texels.colour, colour);
    load(texels.metallic, metallic);
    load(texels.coverage.image, coverage);
    Texture result{name, static_cast<std::uint32_t>(shape->width), static_cast<std::uint32_t>(shape->height), {}};
    // Compute the texels
    constexpr int blue = 2, alpha = 3;
    result.texels.reserve(shape->pixel_count());
    for (std::uint32_t y = 0; y < result.height; ++y)
        for (std::uint32_t x = 0; x < result.width; ++x) {
            const std::size_t pixel = result.texels.size();
            Rgb texel = texels.colour != none ? colour_at(colour, pixel) : Rgb(1);
            float share = texels.metallic_factor;
            if (texels.metallic != none) share *= metallic.value(pixel_at(metallic, x, y, result), blue);
            texel *= texels.factor * (1 - share);
            if (texels.coverage.image != none) {
                const float covered = texels.coverage.at(coverage.value(pixel_at(coverage, x, y, result), alpha));
                texel = texel * covered + texels.open * (1 - covered);
            }
            for (int c = 0; c < 3; ++c) {
                is_reduced |= texel[c] > 1;
                texel[c] = std::min(texel[c], 1.0f);
            }
            result.texels.push_back(texel);
        }
    return result;
}

std::pair<std::uint32_t, bool> GltfImages::texture(const GltfTexels& texels) {
    if (texels.colour == none && texels.metallic == none && texels.coverage.image == none) return {none, false};
    const auto [entry, is_new] = index_.try_emplace(texels.key());
    if (!is_new) return entry->second;
    std::vector<Texture>& made = asset_.model.textures;
    entry->second.first = static_cast<std::uint32_t>(made.size());
    made.push_back(make_texture(texels, entry->second.second));
    texels_ += made.back().texels.size();
    return entry->second;
}

void GltfImages::limit_textures() {
    if (texels_ <= max_texels) return;
    reduce_textures(asset_.model.textures);
    texels_ = texel_count(asset_.model.textures);
    asset_.warn(
        "textures-reduced",
        fmt::format("the largest images are halved in width and height, to at most {} texels in all", max_texels),
        "textures");
}

const GltfImageMeans& GltfImages::means(std::uint32_t image) {
    const auto [entry, is_new] = means_.try_emplace(image);
    GltfImageMeans& result = entry->second;
    if (!is_new) return result;
    const StoredImage pixels = decode(image);
    constexpr int alpha = 3;
    RgbD colour(0), stored(0);
    double opaque = 0;
    for (std::size_t i = 0; i < pixels.pixel_count(); ++i) {
        colour += RgbD(colour_at(pixels, i));
        stored += RgbD(pixels.value(i, 0), pixels.value(i, 1), pixels.value(i, 2));
        opaque += static_cast<double>(pixels.value(i, alpha));
        result.min_alpha = std::min(result.min_alpha, pixels.value(i, alpha));
    }
    const auto count = static_cast<double>(pixels.pixel_count());
    result.colour = Rgb(colour / count);
    result.stored = Rgb(stored / count);
    result.alpha = static_cast<float>(opaque / count);
    return result;
}

}  // namespace interflect::detail
