#include "interflect/exports/lightmap/earlier_lightmap.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "interflect/base/files/crc32.h"
#include "interflect/base/files/escapes.h"
#include "interflect/base/files/input_file.h"
#include "interflect/formats/gltf/data/asset.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

constexpr const char* charts_checksum = "charts";  // member of a layout

/// Returns the paths of images in the folder of the glTF file.
std::vector<fs::path> paths_of(const fs::path& gltf, const Json& names) {
    std::vector<fs::path> paths;
    for (const Json& name : names) {
        const fs::path file = fs::path(unescaped(name.get<std::string>())).filename();
        if (file.extension() != ".exr")
            throw InputError(gltf, 0,
                             fmt::format("cannot be updated: {} is rounded; expected an .exr image", file.string()));
        paths.push_back(gltf.parent_path() / file);
    }
    return paths;
}

Json names_of(const Json& groups) {
    Json names = Json::array();
    for (const Json& group : groups) names.push_back(group.at("name"));
    return names;
}

EarlierLightmap read(const fs::path& path, const Json& description, const LightmapOptions& options,
                     const std::vector<std::string>& group_names) {
    using Limits = std::numeric_limits<float>;
    const Json& lightmap = description.at("lightmap");
    const auto require_equal = [&](const char* what, const Json& found, const Json& expected) {
        if (found != expected)
            throw InputError(path, 0,
                             fmt::format("cannot be updated: the {} is {}, not {}; export the whole lightmap", what,
                                         found.dump(), expected.dump()));
    };
    const auto number = [&](const char* name, const Json& found, float least) {
        const auto value = found.get<double>();
        if (!(value >= least && value <= Limits::max()))
            throw InputError(path, 0, fmt::format("cannot be updated: the {} is {}", name, value));
        return static_cast<float>(value);
    };
    require_equal("quantity", lightmap.at("quantity"), quantity_of(options.content));
    const Json groups = lightmap.value("groups", Json::array());
    Json expected_names = Json::array();
    if (options.groups)
        for (const std::string& name : group_names) expected_names.push_back(escaped(name));
    require_equal("list of light groups with images", names_of(groups), expected_names);

    EarlierLightmap earlier{.path = path,
                            .layout = lightmap.at("layout"),
                            .exposure = number("exposure", description.at("exposure"), Limits::lowest()),
                            .scale = number("scale", lightmap.at("scale"), Limits::min()),
                            .stops = number("range in stops", lightmap.at("stops"), 0),
                            .covered = lightmap.at("covered"),
                            .images = paths_of(path, lightmap.at("unclamped")),
                            .groups = {}};
    for (const Json& group : groups) earlier.groups.push_back(paths_of(path, group.at("unclamped")));
    return earlier;
}

/// Replaces `images` by the contents of the files.
void read_images(const EarlierLightmap& earlier, const std::vector<fs::path>& files, std::vector<Image>& images) {
    bool is_alike = files.size() == images.size();
    for (std::size_t i = 0; is_alike && i < files.size(); ++i) {
        Image read = read_image(files[i]);
        is_alike = read.width == images[i].width && read.height == images[i].height;
        images[i] = std::move(read);
    }
    if (!is_alike) throw InputError(earlier.path, 0, "cannot be updated: the images beside it have other sizes");
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
    for (const LightmapChart& chart : charts) {
        std::string text = fmt::format("{} {} {} {} {} {}", scene.objects[chart.object], chart.page, chart.left,
                                       chart.top, chart.columns, chart.rows);
        for (const FlatPatch& flat : chart.patches)
            for (const Imath::V2d& corner : flat.outline()) {
                const Imath::V2d texel = corner / chart.spacing();
                text += fmt::format(" {} {}", std::llround(8 * texel.x), std::llround(8 * texel.y));
            }
        checksum = crc32(text + '\n', checksum);
    }
    return {{"texels_per_metre", shortest_number(options.texels_per_metre)},
            {"densities", std::move(densities)},
            {"max_size", options.max_size},
            {"gutter", options.gutter},
            {"own_charts", options.own_charts},
            {charts_checksum, text_of_crc32(checksum)}};
}

EarlierLightmap read_earlier_lightmap(const fs::path& path, const LightmapOptions& options,
                                      const std::vector<std::string>& groups) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
        throw InputError(path, 0, "cannot be updated: it is not there; export the whole lightmap first");
    const std::string bytes = read_bytes(path);
    try {
        const Json json = parse_json(gltf_parts(bytes).json);
        return read(path, json.at("asset").at("extras").at("interflect"), options, groups);
    } catch (const Json::exception&) {
        throw InputError(path, 0, "cannot be updated: expected a glTF file with a lightmap of this version");
    } catch (const InputError&) {
        throw;
    } catch (const std::runtime_error& fault) {  // from parse_json() and gltf_parts()
        throw InputError(path, 0, fmt::format("cannot be updated: {}", fault.what()));
    }
}

void require_same_layout(const EarlierLightmap& earlier, const Json& layout) {
    const auto earlier_value = [&](const std::string& key) {
        return earlier.layout.contains(key) ? earlier.layout.at(key) : Json();
    };
    std::string differences;
    for (const auto& [key, value] : layout.items()) {
        const Json found = earlier_value(key);
        if (found != value && key != charts_checksum)
            differences +=
                fmt::format("{}{} is {}, not {}", differences.empty() ? "" : ", ", key, found.dump(), value.dump());
    }
    if (!differences.empty())
        throw InputError(
            earlier.path, 0,
            fmt::format("cannot be updated: its {}; choose its options, or export the whole lightmap", differences));
    if (earlier_value(charts_checksum) != layout.at(charts_checksum))
        throw InputError(earlier.path, 0,
                         "cannot be updated: surfaces have other places or shapes in its images, because the scene's "
                         "geometry has changed; export the whole lightmap");
}

void read_images(const EarlierLightmap& earlier, std::vector<Image>& images, std::vector<std::vector<Image>>& groups) {
    if (groups.empty()) return read_images(earlier, earlier.images, images);
    for (std::size_t g = 0; g < groups.size(); ++g) read_images(earlier, earlier.groups[g], groups[g]);
}

}  // namespace interflect::detail
