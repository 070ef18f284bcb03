#include "interflect/export.h"
#include "interflect/base/memory/machine_memory.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/path_progress.h"
#include "apps/interflect/drawing/denoise_option.h"
#include "apps/interflect/options/light_group_options.h"
#include "apps/interflect/options/refused_options.h"
#include "apps/interflect/options/shading_options.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/solving/read_light.h"
#include "apps/interflect/values/distinct_files.h"
#include "apps/interflect/values/parse.h"
#include "interflect/core.h"
#include "interflect/image.h"
#include "interflect/prepare.h"
#include "interflect/render.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

using namespace detail;

namespace {

/// Resolution of a bake, relative to the library's defaults, which are of medium quality. Numbers of samples and
/// triangles follow its square.
enum class Quality { low, medium, high };
double resolution_of(Quality quality) { return quality == Quality::low ? 0.5 : quality == Quality::high ? 2 : 1; }

struct ExportArguments {
    SceneOptions scene;
    ViewOptions view;
    std::filesystem::path output;
    Size size{1280, 720};
    int samples = 256;
    Exposure exposure;
    std::optional<Imath::V3d> up;
    ProbeOptions probes;
    bool has_lightmap = false;
    BakeOptions bake;
    Quality quality = Quality::medium;
    LightmapOptions lightmap;
    VertexOptions vertices;
    bool has_polygons = false;
    DimmingOptions dimming;
    int threads = 0;
};

constexpr const char* lightmap_group = "Lightmaps";
constexpr const char* bake_group = "Light of texels and vertices";
constexpr const char* vertices_group = "Light in vertices";

/// Options that only some formats use.
struct OptionsOfFormats {
    std::vector<std::string_view> options;  // as for refuse_options()
    std::vector<std::string_view> formats;
};
std::vector<OptionsOfFormats> options_of_formats() {
    return {{{lightmap_group}, {".glb", ".gltf"}},
            {{"--up"}, {".glb", ".gltf", ".rad", ".xml", ".pbrt", ".py"}},
            {{bake_group, vertices_group}, {".glb", ".gltf", ".ply", ".obj"}},
            {{"--exposure"}, {".glb", ".gltf", ".ply", ".obj"}},
            {{"--polygons"}, {".ply", ".obj"}},
            {{"--probe-spacing", "--probe-rays"}, {".json", ".exr"}},
            {{view_group, "--size"}, {".rad", ".xml", ".pbrt", ".py"}},
            {{"--pixel-samples"}, {".xml", ".pbrt", ".py"}}};
}

V3f up_of(const Scene& scene) {
    if (const std::optional<UpAxis> found = find_up_axis(scene)) return found->direction();
    spdlog::warn("{}: the up direction is unknown: taking z (--up chooses another)", scene.name);
    return {0, 0, 1};
}

bool draws_density(const ExportArguments& arguments) {
    return arguments.has_lightmap && arguments.lightmap.content == LightmapContent::density;
}

SolvedScene read_dimmed(const ExportArguments& arguments) {
    SolvedScene solved = read_light_of(arguments.scene.path);
    arguments.dimming.dim(solved);
    return solved;
}

void run_scene(const ExportArguments& arguments) {
    const bool is_solved = is_solution_file(arguments.scene.path);
    const Scene scene = is_solved ? read_dimmed(arguments).scene : arguments.scene.load();
    refuse_overwriting(scene, std::array<NamedFile, 1>{{{"--output", arguments.output}}});
    ViewOptions view = arguments.view;
    if (arguments.up) view.up = V3f(*arguments.up);
    const SceneExport exported = export_scene(
        arguments.output, scene, {arguments.size.width, arguments.size.height, arguments.samples, view.views(scene)});
    for (const auto& path : exported.files) spdlog::info("{}", path.string());
    log_warnings(exported.warnings);
}

bool traces_rays(const std::filesystem::path& output, const ExportOptions& options) {
    const std::string extension = lower_case_extension(output);
    if (options.lightmap && options.lightmap->content == LightmapContent::density) return false;
    const bool is_bake =
        options.lightmap || extension == ".glb" || extension == ".gltf" || extension == ".ply" || extension == ".obj";
    return (is_bake && options.bake.shading != Shading::smooth) || extension == ".json" || extension == ".exr";
}

/// Writes the file. A signal before the first rays ends the process; a later signal stops the rays and keeps a usable
/// result.
std::vector<std::filesystem::path> write(const std::filesystem::path& path, const SolvedScene& solved,
                                         ExportOptions options) {
    LongWork work(fmt::format("exporting {}", path.string()));
    const auto export_light = [&] { return export_solution(path, solved.scene, solved.solution, options); };
    if (!traces_rays(path, options)) return export_light();
    std::vector<std::filesystem::path> written;
    SharedLight shared_light(solved.scene, &solved.solution);
    with_path_progress(shared_light, [&](const Monitor& monitor) {
        options.monitor = monitor;
        options.monitor.on_progress = [&](const Progress& progress) {
            stop_on_signal();
            work.postpone();
            monitor.on_progress(progress);
        };
        written = export_light();
    });
    return written;
}

std::vector<std::filesystem::path> write_or_explain(const std::filesystem::path& path, const SolvedScene& solved,
                                                    const ExportOptions& options) {
    try {
        return write(path, solved, options);
    } catch (const Stopped& e) {
        spdlog::warn("{}: nothing is written", e.what());
        return {};
    }
}

/// Refuses options that the format does not use.
void check_format_options(const ExportArguments& arguments, const CLI::App& command) {
    const std::string extension = lower_case_extension(arguments.output);
    for (const auto& [options, formats] : options_of_formats()) {
        std::string known;
        for (const std::string_view format : formats) known += fmt::format(" {}", format);
        if (std::find(formats.begin(), formats.end(), extension) == formats.end())
            refuse_options(command, options, fmt::format("it has no effect on {}: it is for{}", extension, known));
    }
    constexpr std::array<std::string_view, 1> of_picture = {"--up"};
    if (is_scene_export(arguments.output) && !arguments.view.eye)
        refuse_options(command, of_picture,
                       fmt::format("it has no effect on {} without --eye: it is for .glb .gltf", extension));
    constexpr std::array<std::string_view, 3> of_sampling = {"--samples", "--seed", vertices_group};
    if (arguments.bake.shading == Shading::smooth)
        refuse_options(command, of_sampling, "it has no effect with --shading smooth");
    constexpr std::array<std::string_view, 1> of_effort = {"--quality"};
    if (arguments.bake.shading == Shading::smooth && !arguments.has_lightmap)
        refuse_options(command, of_effort, "it has no effect on vertices with --shading smooth");
    constexpr std::array<std::string_view, 9> of_light = {"--shading",        "--samples",         "--denoise",
                                                          "--seed",           "--exposure",        "--dim",
                                                          "--lightmap-image", "--lightmap-groups", "--update"};
    if (draws_density(arguments)) refuse_options(command, of_light, "it has no effect on density");
}

void set_bake(ExportOptions& options, const ExportArguments& arguments, const CLI::App& command) {
    const auto is_given = [&](const char* option) { return command.get_option(option)->count() > 0; };
    options.bake = arguments.bake;
    options.vertices = arguments.vertices;
    options.polygons = arguments.has_polygons;
    if (arguments.has_lightmap) options.lightmap = arguments.lightmap;
    if (!is_given("--max-edge"))
        options.vertices.max_edge = std::max(options.vertices.max_edge, options.vertices.min_edge);
    const double resolution = resolution_of(arguments.quality);
    const auto scaled = [&](int number) { return static_cast<int>(std::lround(number * resolution * resolution)); };
    if (!is_given("--samples") && traces_paths(arguments.bake.shading))
        options.bake.samples = scaled(require_samples(
            arguments.bake.shading, arguments.has_lightmap ? &DefaultSamples::texel : &DefaultSamples::vertex));
    if (!is_given("--max-triangles")) options.vertices.max_triangles = scaled(options.vertices.max_triangles);
    if (options.lightmap && !is_given("--texels-per-metre"))
        options.lightmap->texels_per_metre *= static_cast<float>(resolution);
}

/// @param lists_objects  Whether to add a line for each object.
void log_summary(const LightmapSummary& summary, bool lists_objects) {
    if (summary.sizes.empty()) return;
    std::string sizes;
    for (const Imath::V2i& size : summary.sizes)
        sizes += fmt::format("{}{} x {}", sizes.empty() ? "" : ", ", size.x, size.y);
    spdlog::info("lightmap: {} {} of {} texels", summary.sizes.size(), summary.sizes.size() == 1 ? "image" : "images",
                 sizes);
    if (!lists_objects) return;
    for (const auto& [object, requested, obtained] : summary.densities)
        spdlog::info("{}: {:.3g} of {:g} texels per metre", object, obtained, requested);
}

void run(const ExportArguments& arguments, const CLI::App& command, int& exit_code) {
    const ThreadLimit threads(arguments.threads);
    if (!is_scene_export(arguments.output))
        check_option("--output", [&] { return require_export_format(arguments.output); });
    check_format_options(arguments, command);
    arguments.scene.check(command);
    arguments.view.check();
    arguments.dimming.require_solution(arguments.scene.path);
    require_denoiser(arguments.bake.denoiser);
    if (arguments.up && !(V3f(*arguments.up).length() > 0)) throw UsageError("--up", "0,0,0 is no direction");
    const NamedFile output{"--output", arguments.output};
    require_distinct_files(input_files(arguments.scene, arguments.view), {&output, 1});
    if (is_scene_export(arguments.output)) return run_scene(arguments);
    const bool needs_light = !draws_density(arguments), is_update = !arguments.lightmap.update.empty();
    const SolvedScene solved =
        needs_light ? read_dimmed(arguments) : read_scene_or_solution(arguments.scene, arguments.dimming);
    refuse_overwriting(solved.scene, {&output, 1});
    ExportOptions options;
    options.exposure = arguments.exposure.stops;
    if (arguments.exposure.relative && needs_light && !is_update)
        options.exposure += export_exposure(solved.scene, solved.solution);
    options.up = arguments.up ? V3f(*arguments.up) : up_of(solved.scene);
    options.probes = arguments.probes;
    set_bake(options, arguments, command);
    if (options.lightmap) options.lightmap->max_bytes = free_memory();
    Warnings warnings;
    options.warnings = &warnings;
    LightmapSummary summary;
    options.summary = &summary;
    for (const auto& path : write_or_explain(arguments.output, solved, options))
        spdlog::info("{}{}", path.string(),
                     needs_light && !is_update ? fmt::format(": exposure {:+.2f}", options.exposure) : "");
    log_summary(summary, !needs_light);
    log_warnings(warnings);
    if (is_stop_requested()) exit_code = interrupted;
}

void add_bake(CLI::App& command, ExportArguments& arguments) {
    const auto group = [](CLI::Option* option) { return option->group(bake_group); };
    group(add_shading(command, arguments.bake.shading, &DefaultSamples::texel, "texel or vertex"));
    group(add_choice<Quality>(command, "--quality", arguments.quality,
                              {{"low", Quality::low}, {"medium", Quality::medium}, {"high", Quality::high}},
                              "low: 10 texels a metre or 50,000 triangles, few samples; medium: 20, 200,000; high: "
                              "40, 800,000, many samples, in three to four times the time of medium"))
        ->default_str("medium");
    group(
        command.add_option("--samples", arguments.bake.samples,
                           fmt::format("Points, or gathered directions, a texel (default: {}) or vertex (default: {})",
                                       text_of_default_samples(&DefaultSamples::texel),
                                       text_of_default_samples(&DefaultSamples::vertex))))
        ->check(CLI::Range(2, 1 << 24));
    group(add_denoiser(command, arguments.bake.denoiser,
                       "Filter noise from hybrid lightmaps, as `render --denoise` does"))
        ->default_str("own");
    group(add_parsed(command, "--seed", arguments.bake.seed, parse_seed, "Of sampling"))->default_str("1");
}

void add_vertices(CLI::App& command, ExportArguments& arguments) {
    VertexOptions& vertices = arguments.vertices;
    const auto of_vertices = [](CLI::Option* option) {
        return option->group(vertices_group)->capture_default_str()->excludes("--lightmap");
    };
    of_vertices(command.add_option("--max-triangles", vertices.max_triangles, "About; faces are never merged"))
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 28));
    of_vertices(command.add_option("--vertex-error", vertices.max_error,
                                   "Largest error of interpolated direct light, relative to the irradiance"))
        ->type_name("FRACTION")
        ->check(number_between(1e-3, 10));
    of_vertices(command.add_option("--min-edge", vertices.min_edge, "Shorter edges are not divided [m]"))
        ->type_name("METRES")
        ->check(number_between(1e-6, 1e15));
    of_vertices(command.add_option("--max-edge", vertices.max_edge, "Longer edges are divided, the longest first [m]"))
        ->type_name("METRES")
        ->check(number_between(1e-6, 1e15));
}

void add_lightmap(CLI::App& command, ExportArguments& arguments) {
    LightmapOptions& lightmap = arguments.lightmap;
    const auto group = [](CLI::Option* option) { return option->group(lightmap_group); };
    CLI::Option* const flag =
        command.add_flag("--lightmap", arguments.has_lightmap, "The light in images, not in vertices");
    group(flag);
    const auto of_lightmap = [&](CLI::Option* option) { return group(option)->needs(flag); };
    of_lightmap(command.add_option("--texels-per-metre", lightmap.texels_per_metre,
                                   "Maximum width and height of the images, at least"))
        ->capture_default_str()
        ->check(number_between(1e-6, 1e6));
    of_lightmap(
        add_each(command, "--density", lightmap.densities, parse_density,
                 "Texels per metre on objects or materials with such a name ('*' stands for anything); 0: no lightmap"))
        ->type_name("PATTERN=N");
    of_lightmap(
        command.add_option("--lightmap-max-size", lightmap.max_size, "Largest side of an image, a multiple of 4"))
        ->capture_default_str()
        ->check(CLI::Range(64, 16384))
        ->check(
            [](const std::string& text) {
                return std::stoi(text) % 4 == 0 ? std::string() : "expected a multiple of 4, found '" + text + "'";
            },
            "");
    of_lightmap(command.add_option("--gutter", lightmap.gutter, "Texels around each surface, filled from its edge"))
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    of_lightmap(add_choice<LightmapContent>(
                    command, "--lightmap-content", lightmap.content,
                    {{"irradiance", LightmapContent::irradiance},
                     {"radiance", LightmapContent::radiance},
                     {"density", LightmapContent::density}},
                    "irradiance, which the renderer multiplies by the reflectance; radiance, shown as it is; or "
                    "density, squares of 8 x 8 texels without light, also of a scene that is not solved"))
        ->default_str("irradiance");
    of_lightmap(add_choice<std::string>(command, "--lightmap-image", lightmap.image, {{"exr", ".exr"}, {"hdr", ".hdr"}},
                                        "Format of the unclamped images beside the file"))
        ->default_str("exr");
    of_lightmap(command.add_flag_callback(
        "--rewrite", [&lightmap] { lightmap.keep_file = false; },
        "Write the scene's faces anew in place of adding the light to its glTF file"));
    of_lightmap(command.add_flag("--keep-lights", lightmap.keep_lights,
                                 "Keep the glTF file's light sources, whose light the lightmap has"));
    of_lightmap(
        command.add_flag("--own-charts", lightmap.own_charts, "Ignore lightmap coordinates of the scene's file"));
    of_lightmap(command.add_flag("--lightmap-groups", lightmap.groups,
                                 "Add unclamped images of each light group alone (see solve --light-groups)"));
    of_lightmap(command.add_option("--update", lightmap.update,
                                   "Compute the light of objects or materials with such a name ('*' stands for "
                                   "anything), and keep the other texels of the existing file"))
        ->type_name("PATTERN")
        ->allow_extra_args(false)
        ->excludes("--exposure");
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<ExportArguments>();
    CLI::App& command = *app.add_subcommand("export", "Write a solved scene, or a scene, for other programs");
    options->scene.add_to(command,
                          "Solution file (.h5); for another renderer or --lightmap-content density also a scene");
    std::string extensions;
    for (const ExportFormat& format : export_formats) extensions += std::string(" ") + format.extension;
    for (const char* extension : scene_export_extensions) extensions += std::string(" ") + extension;
    command.add_option("-o,--output", options->output, "File to write:" + extensions)->required()->type_name("FILE");
    add_parsed(command, "--exposure", options->exposure, parse_exposure,
               "Stops by which colours are brightened, or auto: for the first view, or the lit surfaces")
        ->type_name("STOPS|auto[+STOPS]")
        ->default_str("auto");
    add_parsed(command, "--up", options->up, parse_vector,
               "Up direction (default: of the views, or the light); with --eye: of the picture, as for `render`")
        ->type_name("X,Y,Z");
    command
        .add_option("--probe-spacing", options->probes.spacing,
                    "Maximum distance of irradiance probes (.json, .exr) [m]")
        ->type_name("METRES")
        ->check(number_between(1e-6, 1e15))
        ->capture_default_str();
    command.add_option("--probe-rays", options->probes.rays, "Gathered directions of each probe")
        ->type_name("N")
        ->check(CLI::Range(8, 1 << 20))
        ->capture_default_str();
    add_parsed(command, "--size", options->size, parse_size, "Size of the pictures of scenes for renderers [pixels]")
        ->type_name("WxH")
        ->default_str("1280x720");
    command.add_option("--pixel-samples", options->samples, "Of scenes for renderers")
        ->type_name("N")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    command.add_flag("--polygons", options->has_polygons,
                     "Polygons of up to dozens of corners in .ply and .obj, not triangles: fewer faces, but trimesh "
                     "and Open3D do not read such .ply files");
    options->view.add_without_up(command);
    add_lightmap(command, *options);
    add_bake(command, *options);
    add_vertices(command, *options);
    options->dimming.add_to(command);
    add_threads(command, options->threads);
    command.callback([options, &command, &exit_code] { run(*options, command, exit_code); });
}

}  // namespace interflect::command
