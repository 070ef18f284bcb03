#include "interflect/exports/lightmap/earlier_lightmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interflect/base/files/crc32.h"
#include "interflect/base/files/escapes.h"
#include "interflect/base/files/input_file.h"
#include "interflect/formats/gltf/data/asset.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

constexpr const char* places = "places";  // member of a layout: checksum of the charts' places

/// Reads images from the folder of the glTF file.
std::vector<Image> read_images(const fs::path& gltf, const Json& names) {
    std::vector<Image> images;
    for (const Json& name : names) {
        const fs::path file = fs::path(unescaped(name.get<std::string>())).filename();
        if (file.extension() != ".exr")
            throw InputError(gltf, 0,
                             fmt::format("cannot be updated: {} is rounded; expected an .exr image", file.string()));
        images.push_back(read_image(gltf.parent_path() / file));
    }
    return images;
}

Json names_of(const Json& groups) {
    Json names = Json::array();
    for (const Json& group : groups) names.push_back(group.at("name"));
    return names;
}

EarlierLightmap read(const fs::path& path, const Json& description, const LightmapOptions& options,
                     const std::vector<std::string>& group_names) {
    const Json& lightmap = description.at("lightmap");
    const auto require_equal = [&](const char* what, const Json& found, const Json& expected) {
        if (found != expected)
            throw InputError(path, 0,
                             fmt::format("cannot be updated: the {} is {}, not {}; export the whole lightmap", what,
                                         found.dump(), expected.dump()));
    };
    require_equal("quantity", lightmap.at("quantity"), quantity_of(options.content));
    const Json groups = lightmap.value("groups", Json::array());
    Json expected_names = Json::array();
    if (options.groups)
        for (const std::string& name : group_names) expected_names.push_back(escaped(name));
    require_equal("list of light groups with images", names_of(groups), expected_names);

    EarlierLightmap earlier{.path = path,
                            .layout = lightmap.at("layout"),
                            .exposure = description.at("exposure"),
                            .scale = lightmap.at("scale"),
                            .stops = lightmap.at("stops"),
                            .covered = lightmap.at("covered"),
                            .images = read_images(path, lightmap.at("unclamped")),
                            .groups = {}};
    for (const Json& group : groups) earlier.groups.push_back(read_images(path, group.at("unclamped")));
    return earlier;
}

bool have_sizes(const std::vector<Image>& images, std::span<const Imath::V2i> sizes) {
    return std::equal(
        images.begin(), images.end(), sizes.begin(), sizes.end(),
        [](const Image& image, const auto& size) { return image.width == size.x && image.height == size.y; });
}

}  // namespace

const char* quantity_of(LightmapContent content) {
    switch (content) {
        case LightmapContent::irradiance:
            return "irradiance";
        case LightmapContent::radiance:
            return "radiance";
        case LightmapContent::density:
            return "density";
    }
    return "";
}

Json layout_of(std::span<const LightmapChart> charts, const Scene& scene, const LightmapOptions& options) {
    Json densities = Json::array();
    for (const auto& [pattern, density] : options.densities)
        densities.push_back(Json::array({escaped(pattern), shortest_number(density)}));
    std::uint32_t checksum = 0;
    for (const LightmapChart& chart : charts)
        checksum = crc32(fmt::format("{} {} {} {} {} {}\n", scene.objects[chart.object], chart.page, chart.left,
                                     chart.top, chart.columns, chart.rows),
                         checksum);
    return {{"texels_per_metre", shortest_number(options.texels_per_metre)},
            {"densities", std::move(densities)},
            {"max_size", options.max_size},
            {"gutter", options.gutter},
            {"own_charts", options.own_charts},
            {places, text_of_crc32(checksum)}};
}

EarlierLightmap read_earlier_lightmap(const fs::path& path, const LightmapOptions& options,
                                      const std::vector<std::string>& groups) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
        throw InputError(path, 0, "cannot be updated: it is not there; export the whole lightmap first");
    try {
        const std::string bytes = read_bytes(path);
        const Json json = Json::parse(gltf_parts(bytes).json);
        return read(path, json.at("asset").at("extras").at("interflect"), options, groups);
    } catch (const Json::exception&) {
        throw InputError(path, 0, "cannot be updated: expected a glTF file with a lightmap of this version");
    } catch (const GltfFault& fault) {
        throw InputError(path, 0, fmt::format("cannot be updated: {}", fault.what()));
    }
}

void require_same_layout(const EarlierLightmap& earlier, const Json& layout, std::span<const Imath::V2i> sizes) {
    const auto earlier_value = [&](const std::string& key) {
        return earlier.layout.contains(key) ? earlier.layout.at(key) : Json();
    };
    std::string differences;
    for (const auto& [key, value] : layout.items()) {
        const Json found = earlier_value(key);
        if (found != value && key != places)
            differences +=
                fmt::format("{}{} is {}, not {}", differences.empty() ? "" : ", ", key, found.dump(), value.dump());
    }
    if (!differences.empty())
        throw InputError(
            earlier.path, 0,
            fmt::format("cannot be updated: its {}; choose its options, or export the whole lightmap", differences));
    if (earlier_value(places) != layout.at(places))
        throw InputError(earlier.path, 0,
                         "cannot be updated: surfaces have other places in its images, because the scene's geometry "
                         "has changed; export the whole lightmap");
    const auto is_alike = [&](const std::vector<Image>& images) { return have_sizes(images, sizes); };
    if (!is_alike(earlier.images) || !std::all_of(earlier.groups.begin(), earlier.groups.end(), is_alike))
        throw InputError(earlier.path, 0, "cannot be updated: the images beside it have other sizes");
}

}  // namespace interflect::detail
