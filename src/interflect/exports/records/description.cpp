#include "interflect/exports/records/description.h"

#include <memory>
#include <stdexcept>
#include <utility>

#include "interflect/base/files/crc32.h"
#include "interflect/exports/records/luminaire_records.h"
#include "interflect/exports/records/solve_report.h"
#include "interflect/exports/records/texture_records.h"
#include "interflect/scene/sky/environment_maps.h"

namespace interflect::detail {

namespace {

// Versions of the format that introduced options and the history of iterations.
constexpr int first_with_options = 4;
constexpr int first_with_history = 5;

Json json_of_files(const Scene& scene) {
    Json files = Json::array();
    for (std::size_t i = 0; i < scene.files.size(); ++i) {
        Json& file = files.emplace_back(Json{{"name", scene.files[i]}});
        if (!scene.file_checksums.empty()) file["crc32"] = text_of_crc32(scene.file_checksums.at(i));
    }
    return files;
}

void read_files(const Json& files, int format_version, Scene& scene) {
    if (format_version < first_with_history) {
        scene.files = files.get<std::vector<std::string>>();
        return;
    }
    for (const Json& file : files) {
        scene.files.push_back(file.at("name").get<std::string>());
        if (file.contains("crc32"))
            scene.file_checksums.push_back(
                static_cast<std::uint32_t>(std::stoul(file.at("crc32").get<std::string>(), nullptr, 16)));
    }
    if (!scene.file_checksums.empty() && scene.file_checksums.size() != scene.files.size())
        throw std::runtime_error("files and their checksums differ in number");
}

Json json_of_materials(const std::vector<Material>& materials) {
    Json json = Json::array();
    for (const Material& m : materials) {
        json.push_back({{"name", m.name}, {"reflectance", json_of(m.reflectance)}, {"exitance", json_of(m.exitance)}});
        add_textures(m, json.back());
        if (m.transmittance != Rgb(0)) json.back()["transmittance"] = json_of(m.transmittance);
        if (m.specular_reflectance != Rgb(0)) json.back()["specular_reflectance"] = json_of(m.specular_reflectance);
    }
    return json;
}

void read_scene(const Json& json, int format_version, Scene& scene) {
    scene.name = json.at("scene").get<std::string>();
    if (json.contains("origin")) scene.origin = vector_of<Imath::V3d>(json.at("origin"));
    for (const Json& v : json.at("views")) scene.views.push_back(view_of(v));
    for (const Json& m : json.at("materials")) {
        scene.materials.push_back(
            {m.at("name").get<std::string>(), vector_of<Rgb>(m.at("reflectance")), vector_of<Rgb>(m.at("exitance"))});
        Material& material = scene.materials.back();
        read_textures(m, material);
        if (m.contains("transmittance")) material.transmittance = vector_of<Rgb>(m.at("transmittance"));
        if (m.contains("specular_reflectance"))
            material.specular_reflectance = vector_of<Rgb>(m.at("specular_reflectance"));
    }
    if (json.contains("textures")) scene.textures = textures_of(json.at("textures"));
    const auto webs = webs_of(json.value("photometric_webs", Json::array()));
    MapImages maps;
    for (Texture& image : textures_of(json.value("environment_maps", Json::array())))
        maps.push_back(std::make_shared<Texture>(std::move(image)));
    if (json.contains("luminaires"))
        for (const Json& l : json.at("luminaires")) scene.luminaires.push_back(luminaire_of(l, webs, maps));
    if (json.contains("light_groups"))
        for (const Json& g : json.at("light_groups"))
            scene.light_groups.push_back({g.at("name").get<std::string>(), g.at("pattern").get<std::string>()});
    scene.objects = json.at("objects").get<std::vector<std::string>>();
    if (json.contains("files")) read_files(json.at("files"), format_version, scene);
}

void read_result(const Json& json, int format_version, Solution& solution) {
    IterationReport& last = solution.iterations.emplace_back();
    if (format_version >= first_with_history &&
        with_present_columns(json.at("history").get<std::vector<std::string>>()) != report_columns())
        throw std::runtime_error("it has other columns of its history than expected");
    if (format_version >= first_with_options) {
        read_options(json.at("options"), solution.options);
        last = report_of(json.at("result"));
    } else {
        solution.options.limits.rays = last.rays = json.at("rays").get<std::int64_t>();
    }
}

}  // namespace

std::string describe(const Scene& scene, const Solution& solution, int format_version) {
    // Convert lists
    Json views = Json::array();
    for (const View& v : scene.views) views.push_back(json_of(v));
    Json luminaires = Json::array();
    WebTable webs;
    const MapImages maps = environment_maps(scene);
    for (const Luminaire& l : scene.luminaires) luminaires.push_back(json_of(l, webs, maps));
    const IterationReport last = solution.iterations.empty() ? IterationReport() : solution.iterations.back();
    Json groups = Json::array(), dimming = Json::array();
    for (const LightGroup& g : scene.light_groups) groups.push_back({{"name", g.name}, {"pattern", g.pattern}});
    for (const float factor : solution.dimming) dimming.push_back(shortest_number(factor));
    Json description{{"format", "interflect solution"},
                     {"format_version", format_version},
                     {"version", INTERFLECT_VERSION},
                     {"scene", scene.name},
                     {"files", json_of_files(scene)},
                     {"method", solution.options.method.name},
                     {"seed", solution.options.seed},
                     {"rays", last.rays},
                     {"options", json_of(solution.options)},
                     {"result", json_of(last)},
                     {"history", report_columns()},
                     {"emitted_power", json_of(solution.emitted_power)},
                     {"interrupted", solution.interrupted},
                     {"has_importance", !solution.view_importance.empty()},
                     {"origin", json_of(scene.origin)},
                     {"views", views},
                     {"materials", json_of_materials(scene.materials)},
                     {"luminaires", luminaires},
                     {"light_groups", groups},
                     {"group_names", solution.group_names},
                     {"dimming", dimming},
                     {"objects", scene.objects}};
    if (!scene.textures.empty()) description["textures"] = json_of(scene.textures);
    if (!maps.empty()) {
        Json& images = description["environment_maps"] = Json::array();
        for (const auto& image : maps) images.push_back(json_of(*image));
    }
    if (const Json all = webs.json(); !all.empty()) description["photometric_webs"] = all;
    return json_text(description, 1);
}

bool read_description(std::string_view text, int oldest_format_version, int newest_format_version,
                      SolvedScene& solved) {
    Json json = parse_json(text);
    solved.format_version = json.at("format_version").get<int>();
    if (solved.format_version < oldest_format_version || solved.format_version > newest_format_version)
        throw std::runtime_error("it was written by another version of Interflect");
    if (solved.format_version >= first_with_options) json = parse_json_text(text);  // texts are escaped
    if (json.contains("version")) solved.interflect_version = json.at("version").get<std::string>();
    read_scene(json, solved.format_version, solved.scene);
    Solution& solution = solved.solution;
    solution.options.method = find_method(json.at("method").get<std::string>());
    solution.options.seed = json.at("seed").get<std::uint64_t>();
    read_result(json, solved.format_version, solution);
    solution.emitted_power = vector_of<RgbD>(json.at("emitted_power"));
    solution.interrupted = json.at("interrupted").get<bool>();
    if (json.contains("group_names")) solution.group_names = json.at("group_names").get<std::vector<std::string>>();
    if (json.contains("dimming")) solution.dimming = json.at("dimming").get<std::vector<float>>();
    return json.at("has_importance").get<bool>();
}

}  // namespace interflect::detail
