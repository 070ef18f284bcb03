#include "interflect/exports/gltf/lightmap_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "interflect/base/files/escapes.h"
#include "interflect/exports/mesh/display_range.h"
#include "interflect/formats/text/extension.h"
#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail {

namespace {

/// Returns LightmapEncoding::scale. For irradiance, it is the largest texel, but at most eight times the irradiance
/// displayed as white: a larger scale would make the steps of 8 bits visible in dark areas.
float scale_of(const std::vector<Image>& images, LightmapContent content, float exposure) {
    if (content == LightmapContent::radiance) return std::exp2(-exposure);
    constexpr float headroom = 8;
    float largest = 0;
    for (const Image& image : images)
        for (const Rgb& texel : image.pixels) largest = std::max(largest, largest_channel(texel));
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

int add_image(GltfDocument& document, const Image& image, const std::string& name, float scale) {
    Image encoded = image;
    for (Rgb& texel : encoded.pixels) texel = within_display_range(texel / scale);
    return document.add_texture(encoded, name, false);
}

std::string encode_beside(const Image& image, const std::string& extension, const std::string& quantity) {
    if (extension == ".hdr") return codecs::encode_radiance(image);
    ImageMetadata metadata;
    metadata.quantity = quantity;
    metadata.version = INTERFLECT_VERSION;
    return codecs::encode_exr(image, metadata, {});
}

Json description_of(const BakedImages& baked, const LightmapEncoding& encoding,
                    const std::vector<ExportedFile>& beside) {
    const bool holds_irradiance = encoding.content == LightmapContent::irradiance;
    Json images = Json::array();
    for (const ExportedFile& file : beside) images.push_back(escaped(file.path.filename().string()));
    return {{"exposure", encoding.exposure},
            {"lightmap",
             {{"quantity", holds_irradiance ? "irradiance" : "radiance"},
              {"unit", holds_irradiance ? "lm/m^2" : "cd/m^2"},
              {"encoding", "sRGB, 8 bit; a linear value of 1 stands for `scale`; brighter texels are scaled to it"},
              {"scale", encoding.scale},
              {"unclamped", images},
              {"used", baked.used},
              {"covered", baked.covered}}}};
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

LightmapImages add_lightmap_images(GltfDocument& document, const std::filesystem::path& path, const BakedImages& baked,
                                   const std::vector<std::string>& groups, const ExportOptions& options) {
    const LightmapOptions& chosen = *options.lightmap;
    LightmapImages result;
    result.encoding = {chosen.content, options.exposure, scale_of(baked.images, chosen.content, options.exposure)};
    const std::string quantity =
        chosen.content == LightmapContent::irradiance ? "irradiance [lm/m^2]" : "radiance [cd/m^2]";
    for (std::size_t page = 0; page < baked.images.size(); ++page) {
        const std::string name = name_of_image(path, page);
        result.textures.push_back(add_image(document, baked.images[page], name, result.encoding.scale));
        result.files.push_back(
            {path.parent_path() / (name + chosen.image), encode_beside(baked.images[page], chosen.image, quantity)});
    }
    Json description = description_of(baked, result.encoding, result.files);
    if (!baked.groups.empty())
        description["lightmap"]["groups"] = add_groups(path, baked, groups, chosen.image, quantity, result.files);
    Json& extras = document.json["asset"]["extras"];
    if (!extras.is_object()) extras = Json::object();
    extras["interflect"] = std::move(description);
    return result;
}

}  // namespace interflect::detail
