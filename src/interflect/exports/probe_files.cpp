#include "interflect/exports/probe_files.h"

#include "interflect/exports/files/exported_parts.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail {

namespace {

/// Names of the real spherical harmonics of bands 0 to 2.
constexpr std::array<const char*, 9> harmonics{"Y00", "Y1-1", "Y10", "Y11", "Y2-2", "Y2-1", "Y20", "Y21", "Y22"};

ProbeGrid measured_probes(const Scene& scene, const Solution& solution, const ExportOptions& options) {
    return irradiance_probes(scene, solution, RayCaster(scene), options.probes, options.monitor);
}

Json description(const Scene& scene, const ProbeGrid& grid, const ExportOptions& options) {
    Json inside = Json::array(), errors = Json::array();
    for (const IrradianceProbe& probe : grid.probes) {
        inside.push_back(probe.is_inside ? 1 : 0);
        errors.push_back(probe.standard_error);
    }
    return {{"format", "interflect probes"},
            {"format_version", 1},
            {"version", INTERFLECT_VERSION},
            {"scene", scene.name},
            {"quantity", "irradiance [lm/m^2] of each channel, linear Rec. 709"},
            {"harmonics", harmonics},
            {"first", json_of(grid.first)},
            {"step", json_of(grid.step)},
            {"count", grid.count},
            {"rays", options.probes.rays},
            {"inside", inside},
            {"standard_error", errors}};
}

}  // namespace

std::vector<ExportedFile> make_probes_json(const std::filesystem::path& path, const Scene& scene,
                                           const Solution& solution, const ExportOptions& options) {
    const ProbeGrid grid = measured_probes(scene, solution, options);
    Json json = description(scene, grid, options);
    Json& all = json["coefficients"] = Json::array();
    for (const IrradianceProbe& probe : grid.probes) {
        Json& coefficients = all.emplace_back(Json::array());
        for (const Rgb& c : probe.coefficients) coefficients.push_back(json_of(c));
    }
    return {{path, json_text(std::move(json)) + "\n"}};
}

std::vector<ExportedFile> make_probes_exr(const std::filesystem::path& path, const Scene& scene,
                                          const Solution& solution, const ExportOptions& options) {
    const ProbeGrid grid = measured_probes(scene, solution, options);
    const auto layer = [&](std::size_t k) {
        std::vector<float> values;
        for (const IrradianceProbe& probe : grid.probes)
            for (int c = 0; c < 3; ++c) values.push_back(probe.coefficients[k][c]);
        return values;
    };
    std::vector<std::vector<float>> values;
    std::vector<ImageLayer> layers;
    for (std::size_t k = 1; k < harmonics.size(); ++k) values.push_back(layer(k));
    // Layers refer to `values`, which must not grow any more.
    for (std::size_t k = 1; k < harmonics.size(); ++k) layers.push_back({harmonics[k], "RGB", values[k - 1]});
    Image image(grid.count[0], grid.count[1] * grid.count[2]);
    for (std::size_t i = 0; i < grid.probes.size(); ++i) image.pixels[i] = grid.probes[i].coefficients[0];
    ImageMetadata metadata;
    metadata.quantity = "Y00 of irradiance [lm/m^2]";
    metadata.scene = scene.name;
    metadata.version = INTERFLECT_VERSION;
    metadata.seed = options.probes.seed;
    const auto beside = path_beside(path, "probes.json");
    return {{beside, json_text(description(scene, grid, options)) + "\n"},
            {path, codecs::encode_exr(image, metadata, layers)}};
}

}  // namespace interflect::detail
