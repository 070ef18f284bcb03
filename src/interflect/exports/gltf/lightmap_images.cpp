#include "interflect/exports/gltf/lightmap_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "interflect/base/files/escapes.h"
#include "interflect/exports/mesh/display_range.h"
#include "interflect/formats/text/extension.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"

namespace interflect::detail {

namespace {

float largest_texel(const std::vector<Image>& images) {
    float largest = 0;
    for (const Image& image : images)
        for (const Rgb& texel : image.pixels) largest = std::max(largest, largest_channel(texel));
    return largest;
}

/// Returns LightmapEncoding::scale. For irradiance, it is the largest texel, but at most eight times the irradiance
/// displayed as white: a larger scale would make the steps of 8 bits visible in dark areas.
float scale_of(const std::vector<Image>& images, LightmapContent content, float exposure) {
    if (content == LightmapContent::radiance) return std::exp2(-exposure);
    constexpr float headroom = 8;
    const float largest = largest_texel(images);
    const float most = headroom * std::numbers::pi_v<float> * std::exp2(-exposure);
    return largest > 0 ? std::min(largest, most) : most;
}

/// Returns the name of an image, which differs between a .glb and a .gltf with the same stem.
std::string name_of_image(const std::filesystem::path& path, std::size_t page) {
    const bool is_text = lower_case_extension(path) == ".gltf";
    return fmt::format("{}.lightmap-{}", (is_text ? path.filename() : path.stem()).string(), page);
}

/// Returns the name of an image of a light group. It contains the number of the group, because its name may be invalid
/// in file names.
std::string name_of_image(const std::filesystem::path& path, std::size_t page, std::size_t group) {
    return fmt::format("{}-group-{}", name_of_image(path, page), group);
}

/// Sets the encoding and the stops. An update keeps the encoding of the file, and its stops if it has gains; otherwise
/// the bytes of unchanged light would change.
void set_encoding(LightmapImages& result, const std::vector<Image>& images, const ExportOptions& options,
                  const EarlierLightmap* earlier) {
    const LightmapContent content = options.lightmap->content;
    if (content == LightmapContent::density) {
        result.encoding = {content, /*exposure=*/0};
        return;
    }
    result.encoding = earlier
                          ? LightmapEncoding{content, earlier->exposure, earlier->scale}
                          : LightmapEncoding{content, options.exposure, scale_of(images, content, options.exposure)};
    if (content == LightmapContent::radiance) return;
    const float stops = std::max(0.0f, std::log2(largest_texel(images) / result.encoding.scale));
    result.stops = earlier && earlier->stops > 0 ? earlier->stops : stops;
    if (stops > result.stops && options.warnings)
        options.warnings->add("lightmap-range",
                              "some light exceeds the range of the earlier lightmap: its 8-bit images show the limit");
}

/// Adds an image of irradiance and, if a texel exceeds the scale, an image of gains, 2^(stops * byte / 255). Gains are
/// rounded up: a texel divided by its gain is at most the scale.
void add_irradiance(GltfDocument& document, const Image& image, const std::string& name, LightmapImages& images) {
    Image encoded = image, gains = image;
    bool has_gain = false;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb texel = image.pixels[i] / images.encoding.scale;
        const float over = largest_channel(texel);
        // An update may exceed the stops of its file
        const float byte = over > 1 ? std::min(255.0f, std::ceil(std::log2(over) / images.stops * 255)) : 0;
        encoded.pixels[i] = within_display_range(texel / std::exp2(images.stops * byte / 255));
        gains.pixels[i] = Rgb(srgb_decode(byte / 255));  // cancels the sRGB encoding of the codec
        has_gain |= byte > 0;
    }
    images.textures.push_back(document.add_texture(encoded, name, false));
    images.gains.push_back(has_gain ? document.add_texture(gains, name + "-gain", false) : LightmapImages::no_gain);
}

void add_radiance(GltfDocument& document, const Image& image, const std::string& name, LightmapImages& images) {
    Image encoded = image;
    for (Rgb& texel : encoded.pixels) texel = within_display_range(texel / images.encoding.scale);
    images.textures.push_back(document.add_texture(encoded, name, false));
}

std::string encode_beside(const Image& image, const std::string& extension, const std::string& quantity) {
    if (extension == ".hdr") return codecs::encode_radiance(image);
    ImageMetadata metadata;
    metadata.quantity = quantity;
    metadata.version = INTERFLECT_VERSION;
    return codecs::encode_exr(image, metadata, {});
}

Json description_of(const BakedImages& baked, const LightmapImages& encoded) {
    const LightmapEncoding& encoding = encoded.encoding;
    Json lightmap{{"quantity", quantity_of(encoding.content)}};
    if (encoding.content == LightmapContent::density) {
        lightmap["unit"] = "texels/m";
        lightmap["encoding"] = "squares of 8 x 8 texels; the lowest density of each object is in `densities`";
        for (const auto& [object, requested, obtained] : baked.densities)
            lightmap["densities"].push_back(
                {{"object", escaped(object)}, {"requested", requested}, {"obtained", obtained}});
    } else {
        Json images = Json::array();
        for (const ExportedFile& file : encoded.files) images.push_back(escaped(file.path.filename().string()));
        lightmap["unit"] = encoding.content == LightmapContent::irradiance ? "lm/m^2" : "cd/m^2";
        lightmap["encoding"] =
            "sRGB, 8 bit; a linear value of 1 stands for `scale`; brighter texels are divided by their gain";
        lightmap["scale"] = encoding.scale;
        lightmap["stops"] = encoded.stops;
        lightmap["unclamped"] = std::move(images);
        lightmap["covered"] = baked.covered;
    }
    lightmap["used"] = baked.used;
    lightmap["layout"] = Json::parse(baked.layout);
    return {{"exposure", encoding.exposure}, {"lightmap", std::move(lightmap)}};
}

LightmapSummary summary_of(const BakedImages& baked) {
    LightmapSummary summary{{}, baked.densities};
    for (const Image& image : baked.images) summary.sizes.emplace_back(image.width, image.height);
    return summary;
}

Json add_groups(const std::filesystem::path& path, const BakedImages& baked, const std::vector<std::string>& names,
                const std::string& extension, const std::string& quantity, std::vector<ExportedFile>& files) {
    Json groups = Json::array();
    for (std::size_t g = 0; g < baked.groups.size(); ++g) {
        Json images = Json::array();
        for (std::size_t page = 0; page < baked.groups[g].size(); ++page) {
            const std::string name = name_of_image(path, page, g) + extension;
            files.push_back(
                {path.parent_path() / name,
                 encode_beside(baked.groups[g][page], extension, quantity + " of light group " + escaped(names[g]))});
            images.push_back(escaped(name));
        }
        groups.push_back({{"name", escaped(names[g])}, {"unclamped", images}});
    }
    return groups;
}

}  // namespace

Json moz_lightmap(const LightmapImages& images, int page, int set) {
    const auto number = static_cast<std::size_t>(page);
    Json json{{"index", images.textures[number]}, {"texCoord", set}, {"intensity", images.encoding.intensity()}};
    if (const int gain = images.gains[number]; gain != LightmapImages::no_gain)
        json["extras"]["gain"] = {{"index", gain}, {"stops", images.stops}};
    return json;
}

LightmapImages add_lightmap_images(GltfDocument& document, const std::filesystem::path& path, const BakedImages& baked,
                                   const std::vector<std::string>& groups, const ExportOptions& options,
                                   const EarlierLightmap* earlier) {
    const LightmapOptions& chosen = *options.lightmap;
    LightmapImages result;
    set_encoding(result, baked.images, options, earlier);
    const bool holds_irradiance = chosen.content == LightmapContent::irradiance;
    const std::string quantity = holds_irradiance ? "irradiance [lm/m^2]" : "radiance [cd/m^2]";
    const auto add_image = holds_irradiance ? add_irradiance : add_radiance;
    for (std::size_t page = 0; page < baked.images.size(); ++page) {
        const std::string name = name_of_image(path, page);
        add_image(document, baked.images[page], name, result);
        if (chosen.content == LightmapContent::density) continue;
        result.files.push_back(
            {path.parent_path() / (name + chosen.image), encode_beside(baked.images[page], chosen.image, quantity)});
    }
    if (options.summary) *options.summary = summary_of(baked);
    Json description = description_of(baked, result);
    if (!baked.groups.empty())
        description["lightmap"]["groups"] = add_groups(path, baked, groups, chosen.image, quantity, result.files);
    Json& extras = document.json["asset"]["extras"];
    if (!extras.is_object()) extras = Json::object();
    extras["interflect"] = std::move(description);
    return result;
}

}  // namespace interflect::detail
