#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/progress.h"
#include "apps/interflect/drawing/drawing_progress.h"
#include "apps/interflect/drawing/drawing_time.h"
#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/drawing/show.h"
#include "apps/interflect/drawing/view_check.h"
#include "apps/interflect/options/cut_options.h"
#include "apps/interflect/options/false_colour_options.h"
#include "apps/interflect/options/light_group_options.h"
#include "apps/interflect/options/refused_options.h"
#include "apps/interflect/options/shading_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/solving/read_light.h"
#include "apps/interflect/solving/run_solve.h"
#include "apps/interflect/solving/stats_file.h"
#include "apps/interflect/values/distinct_files.h"
#include "apps/interflect/values/parse.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/base/memory/machine_memory.h"
#include "interflect/core.h"
#include "interflect/image.h"
#include "interflect/image/files/pending_image.h"
#include "interflect/plots.h"
#include "interflect/prepare.h"
#include "interflect/preview.h"
#include "interflect/render.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

using namespace detail;

namespace {

constexpr int usual_reduction = 4;  // previews trace light for one in 4 x 4 pixels
constexpr int preview_samples = 4;  // camera rays per pixel of smooth previews, which need them for edges only

struct RenderArguments {
    SceneOptions scene;
    MeshOptions mesh;
    ViewOptions view;
    CutOptions section;  // floor plan or section
    DimmingOptions dimming;
    SolverOptions solver;
    PathTracerArguments path;
    std::filesystem::path output;
    Size size;               // size of the picture with its legend
    PictureOptions picture;  // options of the renderer, see complete()
    Exposure exposure;
    Tonemap tonemap = Tonemap::srgb;
    float display_luminance = usual_display_luminance;
    Shown shown = Shown::light;
    FalseColourOptions false_colour;
    int legend_rows = 0;  // height of the legend at the foot of the picture
    bool has_default_samples = true;
    bool progressive = false;  // whether better pictures replace the first as the light improves
    int reduction = 1;         // above 1, the picture is a preview() for lack of time

    bool is_in_false_colours() const { return is_quantity(shown) || false_colour.measured; }
    /// Height of the view, above the legend [pixels].
    int rows() const { return size.height - legend_rows; }
    /// Time left for the command [s]; infinite without --time, negative after its limit.
    double seconds_left() const { return solver.time() - seconds_of_process(); }
    /// Derives the options of the renderer from the other options.
    void complete() {
        picture.width = size.width;
        picture.height = rows();
        has_default_samples = picture.samples == 0;  // 0: --samples is not given
        picture.samples = require_samples(picture.shading, &DefaultSamples::pixel, picture.samples);
        picture.until = solver.until();
        picture.seed = solver.seed();
        if (false_colour.measured == Measured::illuminance) picture.quantity = PictureQuantity::irradiance;
    }
};

/// Returns the requested view, else the first view of the scene, if any.
std::optional<View> find_given_view(const Scene& scene, const RenderArguments& options) {
    if (options.section.is_given()) return options.section.view(scene, options.size.width, options.rows());
    const std::vector<View> views = options.view.views(scene);
    if (!views.empty()) return views.front();
    if (!scene.views.empty()) return scene.views.front();
    return std::nullopt;
}

/// Returns an overview and warns about it.
View make_overview(const Scene& scene, const RayCaster& ray_caster) {
    spdlog::warn(
        "{} names no view, and the command line has none: drawing an overview (--eye and --look-at choose another)",
        scene.name);
    return overview(scene, ray_caster);
}

/// A picture with its metadata.
struct Picture {
    Image image;
    std::string quantity = "radiance [cd/m^2]";
    std::optional<float> exposure;  // [stops]; empty for false colours
    std::int64_t non_finite_pixels = 0;
    bool is_black = false;   // whether no light is visible
    TracedPicture traced{};  // result of path tracing, from which layers are written
};

bool is_display_format(const RenderArguments& options) {
    return needs_tone_mapping(require_image_format(options.output));
}

bool is_black(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](const Rgb& pixel) { return pixel == Rgb(0); });
}

/// Returns the exposure [stops]. The automatic exposure is 0 for operators of absolute luminance, which choose the
/// brightness themselves.
float exposure_of(const Image& light, const RenderArguments& options) {
    const bool is_automatic = options.exposure.relative && !is_absolute(options.tonemap);
    return options.exposure.stops + (is_automatic ? automatic_exposure(light) : 0);
}

/// Draws false colours in display formats; other formats contain the values.
Picture picture_of_numbers(const Image& values, const RenderArguments& options) {
    Picture picture;
    picture.quantity = options.false_colour.label();
    picture.image = is_display_format(options) ? options.false_colour.draw(values, options.legend_rows > 0) : values;
    return picture;
}

/// Applies tone mapping for display formats; other formats contain the light.
Picture picture_of_light(const Image& light, const RenderArguments& options) {
    Picture picture;
    picture.exposure = exposure_of(light, options);
    picture.image = is_display_format(options)
                        ? tone_map(light, *picture.exposure, options.tonemap, options.display_luminance)
                        : light;
    return picture;
}

/// Converts the light to a picture. @param light  Radiance, or irradiance if that is shown.
Picture picture_of(const Image& light, std::int64_t non_finite_pixels, const RenderArguments& options) {
    Picture picture = options.false_colour.measured ? picture_of_numbers(luminances(light), options)
                                                    : picture_of_light(light, options);
    picture.non_finite_pixels = non_finite_pixels;
    picture.is_black = is_black(light);
    return picture;
}

/// Writes a picture that a better one will replace.
void write_preview(const Picture& picture, const View& view, const Scene& scene, const RenderArguments& options) {
    PendingFile output(options.output);
    write_image(output, picture.image,
                {view,
                 picture.quantity,
                 scene.name,
                 INTERFLECT_VERSION,
                 options.solver.seed(),
                 picture.exposure.value_or(0),
                 {}});
    spdlog::info("{}: picture so far; a better one will replace it", options.output.string());
}

/// Draws the light in about a second: by preview() for hybrid shading, else by smooth shading with few samples.
Rendering draw_preview(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                       const RenderArguments& options, int reduction, const Monitor& monitor) {
    if (options.picture.shading == Shading::hybrid)
        return preview(scene, solution, ray_caster, view, options.picture,
                       {reduction, options.path.denoise.value_or(Denoiser::automatic)}, monitor);
    PictureOptions smooth = options.picture;
    smooth.samples = std::min(smooth.samples, preview_samples);
    smooth.shading = Shading::smooth;
    return interflect::render(scene, solution, ray_caster, view, smooth, monitor);
}

/// Draws the light by tracing paths. @param solution  Null for shading without a solution.
Picture draw_paths(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, const View& view,
                   const RenderArguments& options) {
    std::function<void(const Image&)> write_as_preview;
    if (options.progressive)
        write_as_preview = [&](const Image& so_far) {
            write_preview(picture_of(so_far, count_non_finite(so_far), options), view, scene, options);
        };
    TracedPicture traced =
        run_path_tracer(scene, solution, ray_caster, view, options.picture, options.path, write_as_preview);
    Picture picture = picture_of(traced.image, traced.non_finite_pixels, options);
    picture.traced = std::move(traced);
    return picture;
}

Picture draw_light(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                   const RenderArguments& options) {
    DrawingProgress progress;
    const Rendering rendering =
        interflect::render(solved.scene, solved.solution, ray_caster, view, options.picture, progress.monitor());
    Picture picture = picture_of(rendering.image, rendering.non_finite_pixels, options);
    if (options.shown == Shown::mesh)
        picture.image = draw_mesh(picture.image, solved.scene, solved.solution, ray_caster, view,
                                  options.picture.samples, options.picture.seed, progress.monitor());
    return picture;
}

std::string label(const RenderArguments& options) {
    return options.false_colour.measured ? options.false_colour.label() : label_of(options.shown);
}

/// Returns the height of the legend [pixels], or 0 if it does not fit.
int legend_rows(const RenderArguments& options) {
    const auto [width, height] = options.size;
    if (!is_display_format(options) || !options.is_in_false_colours()) return 0;
    if (legend_fits(width, height, label(options))) return legend_height(width);
    spdlog::warn("{} x {} pixels have no room for a legend: the colours are not explained", width, height);
    return 0;
}

/// Draws a quantity of the elements, in false colours for display formats.
Picture draw_quantity(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                      const RenderArguments& options) {
    DrawingProgress progress;
    QuantityPicture drawn = show_quantity(options.shown, solved, ray_caster, view, options.picture, progress.monitor());
    if (options.legend_rows > 0) drawn.shown = with_legend(drawn.shown, drawn.scale, label(options));
    Image& image = is_display_format(options) ? drawn.shown : drawn.values;
    return {std::move(image), label(options), {}, drawn.non_finite_pixels};
}

void write_picture(PendingFile& output, const Picture& picture, const View& view, const Scene& scene,
                   std::uint64_t seed, const RenderArguments& options) {
    const LongWork work(fmt::format("writing {}", options.output.string()));
    write_image(output, picture.image,
                {view, picture.quantity, scene.name, INTERFLECT_VERSION, seed, picture.exposure.value_or(0),
                 picture.traced.filter},
                options.path.layers ? layers_of(picture.traced) : std::vector<ImageLayer>());
    if (picture.non_finite_pixels > 0)
        spdlog::warn("{} pixels have no valid value (overflow or NaN)", picture.non_finite_pixels);
    const bool is_exposed = picture.exposure && is_display_format(options);
    spdlog::info("{}: {} x {}, view '{}', {}{}", options.output.string(), picture.image.width, picture.image.height,
                 view.name, picture.quantity, is_exposed ? fmt::format(", exposure {:+.2f}", *picture.exposure) : "");
}

std::array<NamedFile, 3> outputs_of(const RenderArguments& options) {
    return {
        {{"--output", options.output}, {"--stats", options.solver.stats}, {"--error-image", options.path.error_image}}};
}

/// Whether a later picture can replace the output: it is no pipe or device.
bool is_replaceable(const std::filesystem::path& output) {
    std::error_code unknown;
    const auto status = std::filesystem::status(output, unknown);
    return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

/// Whether previews precede the last picture. Without --progressive, they are omitted under a time limit, with --show,
/// in .exr and .hdr, for small pictures, and for pipes and devices.
bool takes_previews(const RenderArguments& options) {
    constexpr std::size_t fewest_pixels = 1 << 16;  // smaller pictures take less than a second
    if (options.progressive) return true;
    return !std::isfinite(options.solver.time()) && is_display_format(options) && options.shown == Shown::light &&
           options.size.pixels() >= fewest_pixels && is_replaceable(options.output);
}

/// Draws and writes a preview of the light so far.
void write_preview_of(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                      const RenderArguments& options, int reduction) {
    const Rendering drawn = draw_preview(scene, solution, ray_caster, view, options, reduction, {{}, &stop_flag()});
    if (!drawn.interrupted)
        write_preview(picture_of(drawn.image, drawn.non_finite_pixels, options), view, scene, options);
}

/// Predicts the time of drawing. Chooses a preview, or smooth shading with few samples, if the time is too short.
DrawingTime schedule_drawing(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                             const View& view, RenderArguments& options) {
    if (traces_paths(options.picture.shading)) {
        const double limit = options.path.has_path_outputs() ? std::numeric_limits<double>::infinity()
                                                             : largest_drawing_share * options.seconds_left();
        const DrawingTime paths =
            predict_time_of_paths(scene, solution, ray_caster, view, options.picture, options.path.denoise, limit);
        const double left = options.seconds_left();
        const bool is_in_time = paths.total() <= largest_drawing_share * left;
        options.reduction = paths.reduction;
        if (paths.reduction > 1)
            spdlog::warn(
                "--time is too short for all pixels: light is traced for one in {} x {}, so small shadows are "
                "blurred; a smaller --size takes less time",
                paths.reduction, paths.reduction);
        if (is_in_time || options.picture.shading == Shading::hybrid || options.path.has_path_outputs()) {
            if (!is_in_time)
                spdlog::warn("drawing takes about {}, but --time leaves {}: the picture will be late",
                             duration(paths.total()), duration(std::max(0.0, left)));
            return paths;
        }
        spdlog::warn(
            "per-pixel shading takes about {}, but --time leaves {}: the light is drawn as with --shading "
            "smooth; a smaller --size takes less time",
            duration(paths.total()), duration(std::max(0.0, left)));
        options.picture.shading = Shading::smooth;
        options.picture.samples = std::min(options.picture.samples, preview_samples);
    }
    return predict_time_of_elements(scene, solution, ray_caster, view, options.picture);
}

/// Draws the light of a solution. If a signal stops path tracing before every pixel has light, draws a preview.
Picture draw_solution(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                      const RenderArguments& options) {
    if (is_quantity(options.shown)) return draw_quantity(solved, ray_caster, view, options);
    if (!traces_paths(options.picture.shading)) return draw_light(solved, ray_caster, view, options);
    // After a signal, path tracing would end before its first ray, so only its own outputs need it.
    if (options.path.has_path_outputs() || (options.reduction == 1 && !is_stop_requested())) {
        Picture picture = draw_paths(solved.scene, &solved.solution, ray_caster, view, options);
        if (options.path.has_path_outputs() || has_every_pixel(picture.traced)) return picture;
    }
    if (options.reduction == 1) spdlog::warn("stopped before each pixel had enough light: the picture is a rough one");
    DrawingProgress progress;
    const Rendering drawn =
        draw_preview(solved.scene, solved.solution, ray_caster, view, options,
                     options.reduction > 1 ? options.reduction : usual_reduction, progress.monitor());
    return picture_of(drawn.image, drawn.non_finite_pixels, options);
}

/// Draws the light of a solution. If the input is a scene, solves it first.
void run_solution(RenderArguments& options, PendingFile& output) {
    // Read the solution, or read the scene and divide it.
    const bool solved_before = is_solution_file(options.scene.path);
    SolvedScene solved = read_scene_or_solution(options.scene, options.dimming);
    require_no_scene_files(solved.scene, outputs_of(options));
    const std::optional<View> given_view = find_given_view(solved.scene, options);
    if (given_view) require_picture(*given_view, options.size.width, options.size.height, solved.scene.origin);
    const float aspect = static_cast<float>(options.size.width) / static_cast<float>(options.size.height);
    // A floor plan or section shows the whole scene equally, so importance has no benefit. An overview replaces the
    // default View below, since it needs the divided scene, whose division depends on the other settings.
    const std::vector<View> important =
        options.section.is_given() ? std::vector<View>() : std::vector{given_view.value_or(View())};
    SolveOptions solve_options = options.solver.resolved(important, aspect, options.size.height);
    if (!solved_before)
        solved.scene = options.mesh.divide(std::move(solved.scene), options.scene.read, solve_options.method.refines);
    StatsFile stats(options.solver.threads, options.solver.stats);
    const RayCaster ray_caster = make_ray_caster(solved.scene);
    const View view = given_view ? *given_view : make_overview(solved.scene, ray_caster);
    if (!given_view) {
        require_picture(view, options.size.width, options.size.height, solved.scene.origin);
        solve_options.views.front().view = view;
    }
    warn_of_camera_outside(solved.scene, ray_caster, view, aspect);

    // --time limits the whole command.
    constexpr double shortest_time = 1e-3;  // [s]; replaces times that are 0 or negative
    const bool is_limited = !solved_before && std::isfinite(options.solver.time());
    // The first preview takes about a second itself; with --progressive, a viewer waits for it.
    double seconds_to_preview = options.progressive ? 0.25 : 1;
    if (is_limited) {
        const double left = std::max(shortest_time, options.seconds_left());
        seconds_to_preview = std::min(seconds_to_preview, left / 10);  // when drawing is scheduled
        solve_options.limits.time = left / 3;  // provisional, until the drawing time is predicted
    }

    std::optional<DrawingTime> scheduled;
    // Called with the first light of the run. Writes a preview; with --time, predicts the drawing time and returns
    // the time limit that remains for solving.
    const auto preview_and_schedule = [&](const Solution& so_far) -> std::optional<Limits> {
        if (takes_previews(options)) write_preview_of(solved.scene, so_far, ray_caster, view, options, usual_reduction);
        if (!is_limited) return std::nullopt;
        scheduled = schedule_drawing(solved.scene, so_far, ray_caster, view, options);
        const double left = options.seconds_left(),
                     spent = so_far.iterations.empty() ? 0 : so_far.iterations.back().seconds;
        Limits limits = solve_options.limits;
        // Only path tracing of all pixels uses the time that is left.
        const bool is_refined = traces_paths(options.picture.shading) && options.reduction == 1;
        limits.time = spent + std::max(shortest_time, left - reserved_for(*scheduled, is_refined, left));
        return limits;
    };
    if (!solved_before)
        solved.solution =
            run_solve(solved.scene, ray_caster, solve_options, options.solver.memory, {},
                      {.after = seconds_to_preview, .repeats = options.progressive, .use = preview_and_schedule});

    // Write a preview with more pixels, or the first preview of a run that ended before it or of a solution file.
    if (options.progressive && options.picture.shading == Shading::hybrid && !is_stop_requested())
        write_preview_of(solved.scene, solved.solution, ray_caster, view, options, usual_reduction / 2);
    else if (traces_paths(options.picture.shading) && !scheduled && !is_stop_requested())
        preview_and_schedule(solved.solution);

    // Draw within the remaining time.
    if (is_limited && scheduled && options.reduction == 1) {
        PictureOptions& picture = options.picture;
        picture.time = std::max(shortest_time, options.seconds_left() - scheduled->finishing);
        // Without --samples, time alone limits the number.
        if (!options.has_default_samples) picture.max_samples = picture.samples;
        if (picture.shading == Shading::hybrid)
            picture.samples = std::min(picture.samples, scheduled->samples_within(picture.time));
    }
    const Picture picture = draw_solution(solved, ray_caster, view, options);
    if (picture.is_black) warn_of_darkness(solved.scene, ray_caster, view, aspect);
    write_picture(output, picture, view, solved.scene, solved.solution.options.seed, options);
    if (!solved_before) stats.write(solved.scene, solved.solution);
}

/// Draws the light by tracing paths without a solution. From a solution file, only the scene is used.
void run_paths(const RenderArguments& options, PendingFile& output) {
    Scene scene = read_scene_or_solution(options.scene, options.dimming).scene;
    require_no_scene_files(scene, outputs_of(options));
    if (!is_solution_file(options.scene.path)) scene = options.mesh.cut(std::move(scene), options.scene.read);
    const std::optional<View> given_view = find_given_view(scene, options);
    const RayCaster ray_caster = make_ray_caster(scene);
    const View view = given_view ? *given_view : make_overview(scene, ray_caster);
    const float aspect = static_cast<float>(options.size.width) / static_cast<float>(options.size.height);
    warn_of_camera_outside(scene, ray_caster, view, aspect);
    const Picture picture = draw_paths(scene, nullptr, ray_caster, view, options);
    if (picture.is_black) warn_of_darkness(scene, ray_caster, view, aspect);
    write_picture(output, picture, view, scene, options.solver.seed(), options);
}

/// @throws std::runtime_error if a picture of elements does not fit into memory.
void require_memory_for_elements(Size size) {
    constexpr std::size_t bytes_per_pixel = 64;  // measured: 56 bytes for light, picture and false colours
    require_free_memory(size.pixels() * bytes_per_pixel,
                        fmt::format("a picture of {} x {} pixels", size.width, size.height),
                        "a smaller --size needs less");
}

/// Warns about options of brightness without effect. @throws UsageError for --display-luminance without effect.
void check_tone_options(const RenderArguments& options, const CLI::App& command) {
    if (command.get_option("--display-luminance")->count() > 0 && !is_absolute(options.tonemap))
        throw UsageError("--display-luminance has no effect: it is for --tonemap ward, tumblin and ferwerda");
    for (const char* name : {"--exposure", "--tonemap"}) {
        if (command.get_option(name)->count() == 0) continue;
        if (options.is_in_false_colours())
            spdlog::warn("{} has no effect: numbers are drawn in false colours", name);
        else if (!is_display_format(options))
            spdlog::warn("{} does not change linear values, which {} holds: it is for .png and .jpg", name,
                         options.output.string());
    }
}

void check_false_colours(const RenderArguments& options) {
    options.false_colour.check();
    if (options.false_colour.measured && options.shown != Shown::light)
        throw UsageError("--false-colour", "only pictures of light are measured, and --show draws something else");
    const bool is_drawn =
        options.false_colour.scale || options.false_colour.logarithmic || options.false_colour.isolines;
    if (is_drawn && !is_display_format(options))
        spdlog::warn("{} holds the numbers themselves: --scale, --logarithmic and --isolines are for .png and .jpg",
                     options.output.string());
}

/// @throws UsageError where --progressive cannot be obeyed.
void check_progress(const RenderArguments& options) {
    if (!options.progressive) return;
    if (std::isfinite(options.solver.time()))
        throw UsageError("--progressive", "--time writes one picture, at the end");
    if (options.shown != Shown::light)
        throw UsageError("--progressive", "only pictures of light improve, and --show draws something else");
    if (!is_replaceable(options.output))
        throw UsageError("--progressive", fmt::format("{} is no file, whose picture a better one could replace",
                                                      options.output.string()));
}

/// Checks all options before it traces the first ray, then draws the picture.
void run(RenderArguments& options, const CLI::App& command, int& exit_code) {
    const ThreadLimit threads(options.solver.threads);
    // Refuse options that the output or the shading does not use.
    check_option("--output", [&] { return require_image_format(options.output); });
    Shading& shading = options.picture.shading;
    const bool uses_solution = needs_solution(shading);
    const bool shows_elements = options.shown != Shown::light && uses_solution;
    if (shows_elements && traces_paths(shading)) {
        if (command.get_option("--shading")->count() > 0)
            throw UsageError("--shading", fmt::format("--show draws the elements without tracing paths: expected flat "
                                                      "or smooth, found {}",
                                                      label(shading)));
        shading = Shading::smooth;
    }
    if (!uses_solution)
        refuse_solver_options(command);
    else if (shows_elements)
        refuse_path_options(command, "--show draws the elements without tracing paths");
    else if (!traces_paths(shading))
        refuse_path_options(command);
    if (shading != Shading::instant && command.get_option("--light-walks")->count() > 0)
        throw UsageError("--light-walks", "only --shading instant takes it");
    if (options.path.layers && require_image_format(options.output) != ImageFormat::exr)
        throw UsageError("--layers", "layers need a picture in OpenEXR: expected an --output that ends in .exr");
    if (!can_hold(require_image_format(options.output), options.size.width, options.size.height))
        throw UsageError("--size",
                         fmt::format("{} x {} pixels are too many for a PNG: expected fewer, or another format",
                                     options.size.width, options.size.height));
    if (options.shown == Shown::mesh && !is_display_format(options))
        throw UsageError("--show", fmt::format("the mesh is drawn for people: expected an --output that ends in .png "
                                               "or .jpg, found '{}'",
                                               options.output.string()));
    // Check each group of options, and derive the options of the picture.
    options.scene.check(command, traces_paths(shading));
    options.view.check();
    if (options.view.count() > 1) throw UsageError("--view", "a picture has one view, but several were given");
    options.dimming.require_solution(options.scene.path);
    // By default, pictures for display are filtered.
    if (uses_solution && command.get_option("--denoise")->count() == 0 && is_display_format(options))
        options.path.denoise = Denoiser::automatic;
    check_tone_options(options, command);
    check_false_colours(options);
    check_progress(options);
    options.section.check();
    options.path.check();
    options.legend_rows = legend_rows(options);
    options.complete();
    if (traces_paths(shading)) options.path.check_samples(command, options.picture.samples);
    require_distinct_files(input_files(options.scene, options.view), outputs_of(options));
    require_text_name({"--stats", options.solver.stats});
    if (traces_paths(shading))
        require_memory_for_paths(options.size);
    else
        require_memory_for_elements(options.size);
    PendingFile output(options.output);
    if (uses_solution)
        run_solution(options, output);
    else
        run_paths(options, output);
    if (is_stop_requested()) exit_code = interrupted;
}

void add_tone_options(CLI::App& command, RenderArguments& options) {
    add_parsed(command, "--exposure", options.exposure, parse_exposure,
               "Brightness of .png and .jpg: 1 more is twice as bright; auto+1 is twice as bright as auto. For "
               "ward, tumblin and ferwerda auto is 0: they choose the brightness")
        ->type_name("STOPS|auto[+-STOPS]")
        ->default_str("auto");
    add_choice<Tonemap>(command, "--tonemap", options.tonemap,
                        {{"srgb", Tonemap::srgb},
                         {"reinhard", Tonemap::reinhard},
                         {"filmic", Tonemap::filmic},
                         {"agx", Tonemap::agx},
                         {"ward", Tonemap::ward},
                         {"tumblin", Tonemap::tumblin},
                         {"ferwerda", Tonemap::ferwerda}},
                        "Tone mapping of .png and .jpg. srgb: true ratios, clipped; reinhard, filmic, agx: curves with "
                        "soft highlights; ward, tumblin, ferwerda: brightness by luminance [cd/m^2]")
        ->default_str("srgb");
    command
        .add_option("--display-luminance", options.display_luminance,
                    "Luminance of the display's white, for ward, tumblin and ferwerda [cd/m^2]")
        ->check(number_between(1, 10000))
        ->type_name("CD/M2")
        ->default_str("100");
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RenderArguments>();
    CLI::App& command =
        *app.add_subcommand("render", "Draw a view of a solution, or of a scene after solving it or by path tracing");
    options->scene.add_to(command, std::string(scene_formats) + ", solved first, or solution file (.h5)");
    command.add_option("-o,--output", options->output, "Picture to write: .png .jpg .exr .hdr")
        ->required()
        ->type_name("FILE");
    options->view.add_to(command);
    options->section.add_to(command, {"--view", "--view-file", "--eye"});
    add_parsed(command, "--size", options->size, parse_size, "Picture size in pixels")
        ->type_name("WxH")
        ->default_str("1280x720");
    command
        .add_option("--samples", options->picture.samples,
                    fmt::format("Camera rays a pixel (default: {})", text_of_default_samples(&DefaultSamples::pixel)))
        ->check(CLI::Range(1, 65536));
    add_shading(command, options->picture.shading, &DefaultSamples::pixel, "pixel");
    command
        .add_option("--light-walks", options->picture.light_walks,
                    "Number of random walks that place virtual lights, for each batch of samples "
                    "(--shading instant)")
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 18))
        ->group(path_group);
    options->path.add_to(command, options->picture);
    command.add_flag("--progressive", options->progressive,
                     "Write a rough picture after about a second, and better ones in its place until the last");
    add_tone_options(command, *options);
    add_show(command, options->shown);
    options->false_colour.add_to(command);
    options->dimming.add_to(command);
    options->solver.add_to(command);
    command.get_option("--rays")->description(
        "Maximum number of rays, such as 20M (default 20M, unless --until is given)");
    command.get_option("--time")->description(
        "Maximum time of the whole command [s], divided between solving and drawing; if it is too short, light is "
        "traced for fewer pixels");
    options->mesh.add_to(command);
    command.callback([options, &command, &exit_code] { run(*options, command, exit_code); });
}

}  // namespace interflect::command
