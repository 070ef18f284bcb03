#include "apps/interflect/render/complete_options.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstddef>

#include "apps/interflect/options/refused_options.h"
#include "apps/interflect/render/previews.h"
#include "interflect/base/memory/machine_memory.h"
#include "interflect/core.h"
#include "interflect/plots.h"

namespace interflect::command {

using namespace detail;

namespace {

bool is_given(const CLI::App& command, const char* option) { return command.get_option(option)->count() > 0; }

bool shows_elements(const RenderArguments& options) {
    return options.shown != Shown::light && needs_solution(options.picture.shading);
}

/// Replaces the default shading where --show draws elements. @throws UsageError if it was requested.
void choose_shading(RenderArguments& options, const CLI::App& command) {
    Shading& shading = options.picture.shading;
    if (!shows_elements(options) || !traces_paths(shading)) return;
    if (is_given(command, "--shading"))
        throw UsageError("--shading", fmt::format("--show draws the elements without tracing paths: expected flat "
                                                  "or smooth, found {}",
                                                  label(shading)));
    shading = Shading::smooth;
}

/// @throws UsageError for options that the shading does not use.
void refuse_unused_options(const RenderArguments& options, const CLI::App& command) {
    const Shading shading = options.picture.shading;
    if (!needs_solution(shading))
        refuse_solver_options(command);
    else if (shows_elements(options))
        refuse_path_options(command, "--show draws the elements without tracing paths");
    else if (!traces_paths(shading))
        refuse_path_options(command);
    if (shading != Shading::instant && is_given(command, "--light-walks"))
        throw UsageError("--light-walks", "only --shading instant takes it");
}

/// @throws UsageError if the format of the output cannot contain the picture.
void check_output_format(const RenderArguments& options) {
    const ImageFormat format = require_image_format(options.output);
    if (options.path.layers && format != ImageFormat::exr)
        throw UsageError("--layers", "layers need a picture in OpenEXR: expected an --output that ends in .exr");
    if (!can_hold(format, options.size.width, options.size.height))
        throw UsageError("--size",
                         fmt::format("{} x {} pixels are too many for a PNG: expected fewer, or another format",
                                     options.size.width, options.size.height));
    if (options.shown == Shown::mesh && !options.is_for_display())
        throw UsageError("--show", fmt::format("the mesh is drawn for people: expected an --output that ends in .png "
                                               "or .jpg, found '{}'",
                                               options.output.string()));
}

void check_scene_and_view(const RenderArguments& options, const CLI::App& command) {
    options.scene.check(command, traces_paths(options.picture.shading));
    options.view.check();
    if (options.view.count() > 1) throw UsageError("--view", "a picture has one view, but several were given");
    options.dimming.require_solution(options.scene.path);
}

/// Filters pictures of a solution by default if they are for display.
void choose_denoiser(RenderArguments& options, const CLI::App& command) {
    if (needs_solution(options.picture.shading) && !is_given(command, "--denoise") && options.is_for_display())
        options.path.denoise = Denoiser::automatic;
}

/// Warns about options of brightness without effect. @throws UsageError for --display-luminance without effect.
void check_tone_options(const RenderArguments& options, const CLI::App& command) {
    if (is_given(command, "--display-luminance") && !is_absolute(options.tonemap))
        throw UsageError("--display-luminance has no effect: it is for --tonemap ward, tumblin and ferwerda");
    for (const char* name : {"--exposure", "--tonemap"}) {
        if (!is_given(command, name)) continue;
        if (options.shows_numbers())
            spdlog::warn("{} has no effect: numbers are drawn in false colours", name);
        else if (!options.is_for_display())
            spdlog::warn("{} does not change linear values, which {} holds: it is for .png and .jpg", name,
                         options.output.string());
    }
}

void check_false_colours(const RenderArguments& options) {
    options.false_colour.check();
    if (options.false_colour.measured && options.shown != Shown::light)
        throw UsageError("--false-colour", "only pictures of light are measured, and --show draws something else");
    const bool changes_colours =
        options.false_colour.scale || options.false_colour.logarithmic || options.false_colour.isolines;
    if (changes_colours && !options.is_for_display())
        spdlog::warn("{} holds the numbers themselves: --scale, --logarithmic and --isolines are for .png and .jpg",
                     options.output.string());
}

void check_progressive(const RenderArguments& options) {
    if (!options.progressive) return;
    if (options.has_time_limit()) throw UsageError("--progressive", "--time writes one picture, at the end");
    if (options.shown != Shown::light)
        throw UsageError("--progressive", "only pictures of light improve, and --show draws something else");
    if (!is_replaceable(options.output))
        throw UsageError("--progressive", fmt::format("{} is no file, whose picture a better one could replace",
                                                      options.output.string()));
}

/// Returns the height of the legend [pixels]. Returns 0, with a warning, if the picture has no room for it.
int choose_legend_rows(const RenderArguments& options) {
    if (!options.is_for_display() || !options.shows_numbers()) return 0;
    const auto [width, height] = options.size;
    if (legend_fits(width, height, options.label_of_numbers())) return legend_height(width);
    spdlog::warn("{} x {} pixels have no room for a legend: the colours are not explained", width, height);
    return 0;
}

void complete_picture_options(RenderArguments& options) {
    PictureOptions& picture = options.picture;
    picture.width = options.size.width;
    picture.height = options.view_rows();
    options.has_default_samples = picture.samples == 0;  // the value without --samples
    picture.samples = require_samples(picture.shading, &DefaultSamples::pixel, picture.samples);
    picture.until = options.solver.until();
    picture.seed = options.solver.seed();
    if (options.false_colour.measured == Measured::illuminance) picture.quantity = PictureQuantity::irradiance;
}

void check_files(const RenderArguments& options) {
    require_distinct_files(input_files(options.scene, options.view), options.outputs());
    require_text_name({"--stats", options.solver.stats});
}

/// @throws std::runtime_error if a picture of elements does not fit into memory.
void require_memory_for_elements(Size size) {
    constexpr std::size_t bytes_per_pixel = 64;  // measured: 56 bytes for light, picture and false colours
    require_free_memory(size.pixels() * bytes_per_pixel,
                        fmt::format("a picture of {} x {} pixels", size.width, size.height),
                        "a smaller --size needs less");
}

}  // namespace

void complete_options(RenderArguments& options, const CLI::App& command) {
    check_option("--output", [&] { return require_image_format(options.output); });
    choose_shading(options, command);
    refuse_unused_options(options, command);
    check_output_format(options);
    check_scene_and_view(options, command);
    choose_denoiser(options, command);
    check_tone_options(options, command);
    check_false_colours(options);
    check_progressive(options);
    options.section.check();
    options.path.check();
    options.legend_rows = choose_legend_rows(options);
    complete_picture_options(options);
    const bool uses_paths = traces_paths(options.picture.shading);
    if (uses_paths) options.path.check_samples(command, options.picture.samples);
    check_files(options);
    if (uses_paths)
        require_memory_for_paths(options.size);
    else
        require_memory_for_elements(options.size);
}

}  // namespace interflect::command
