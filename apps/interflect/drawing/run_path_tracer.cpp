#include "apps/interflect/drawing/run_path_tracer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "apps/interflect/console/path_progress.h"
#include "apps/interflect/console/progress.h"
#include "apps/interflect/drawing/denoise_option.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/values/parse.h"
#include "apps/interflect/values/percent.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/base/memory/machine_memory.h"
#include "interflect/core.h"
#include "interflect/image.h"
#include "interflect/image/files/pending_image.h"
#include "interflect/render.h"

namespace interflect::command {

using namespace detail;

namespace {

/// @param shading  One that traces paths.
const char* name_of(Shading shading) {
    switch (shading) {
        case Shading::path:
            return "path tracing";
        case Shading::instant:
            return "instant radiosity";
        case Shading::gather:
            return "final gathering";
        default:
            return "hybrid shading";
    }
}

void log_path_tracing(Shading shading, const Rendering& traced, double seconds) {
    const auto rays = static_cast<double>(traced.rays);
    const std::string escaped =
        traced.escaped_rays > 0
            ? fmt::format(", {} of the rays left the scene", percent(static_cast<double>(traced.escaped_rays) / rays))
            : "";
    spdlog::info("{}: {} paths, {} rays in {}, estimated relative error {} a pixel{}", name_of(shading),
                 magnitude(static_cast<double>(traced.paths)), magnitude(rays), duration(seconds),
                 percent(traced.relative_error), escaped);
}

struct TimedRendering {
    Rendering rendering;
    double seconds = 0;  // duration of tracing
};

/// Traces paths until they are complete or a signal ends them. @param arguments  Denoiser of pictures for `on_picture`.
TimedRendering trace_with_progress(SharedLight& shared_light, const Scene& scene, const Solution* solution,
                                   const RayCaster& ray_caster, const View& view, const PictureOptions& options,
                                   const PathTracerArguments& arguments,
                                   const std::function<void(const Image&)>& on_picture) {
    TimedRendering traced;
    traced.seconds = with_path_progress(shared_light, [&](Monitor monitor) {
        if (on_picture)
            monitor.on_picture = [&](const Rendering& so_far) {
                on_picture(arguments.denoise ? interflect::denoise(so_far.layers, *arguments.denoise).image
                                             : so_far.image);
            };
        traced.rendering = solution ? render(scene, *solution, ray_caster, view, options, monitor)
                                    : render(scene, ray_caster, view, options, monitor);
    });
    return traced;
}

void filter_noise(TracedPicture& traced, Denoiser denoiser) {
    const LongWork work("filtering noise");
    DenoisedPicture denoised = interflect::denoise(traced.layers, denoiser);
    traced.image = std::move(denoised.image);
    if (!denoised.standard_error.pixels.empty()) traced.standard_error = std::move(denoised.standard_error);
    traced.filter = denoised.filter;
}

void write_error_image(PendingFile& file, const TracedPicture& traced, const Scene& scene, const View& view,
                       const PictureOptions& options) {
    const char* unit = options.quantity == PictureQuantity::irradiance ? "irradiance [lx]" : "radiance [cd/m^2]";
    write_image(file, traced.standard_error,
                {.view = view,
                 .quantity = std::string("standard error of ") + unit,
                 .scene = scene.name,
                 .version = INTERFLECT_VERSION,
                 .seed = options.seed,
                 .exposure = 0,
                 .filter = traced.filter});
}

}  // namespace

void PathTracerArguments::add_to(CLI::App& app, PictureOptions& picture) {
    app.add_option("--max-samples", picture.max_samples, "Most paths a pixel with --until")
        ->capture_default_str()
        ->check(CLI::Range(2, 1 << 24))
        ->group(path_group);
    add_denoiser(app, denoise,
                 "Filter noise from the light, but not from textures and edges: by Intel Open Image Denoise (oidn), by "
                 "this program's filter (own), or by the first that is found (auto, the default for a solution's .png "
                 "and .jpg). Alone it means auto; --no-denoise means off")
        ->group(path_group);
    app.add_flag("--layers", layers,
                 "Write direct and indirect light, albedo, normal, depth, variance and element level too: .exr")
        ->group(path_group);
    app.add_flag(
           "--mirrors,!--no-mirrors", picture.mirrors,
           "Show the reflections in mirrors (default), or leave them out, as all other light that mirrors reflect")
        ->group(path_group);
    app.add_option("--error-image", error_image, "Write the standard error of each pixel: .exr .hdr")
        ->type_name("FILE")
        ->group(path_group);
}

void PathTracerArguments::check() const {
    require_denoiser(denoise);
    if (error_image.empty()) return;
    const ImageFormat format = check_option("--error-image", [&] { return require_image_format(error_image); });
    if (needs_tone_mapping(format))
        throw UsageError("--error-image",
                         fmt::format("standard errors are numbers to measure with: expected .exr or .hdr, found '{}'",
                                     error_image.string()));
}

void PathTracerArguments::check_samples(const CLI::App& app, int samples) {
    if (samples < 2)
        throw UsageError("--samples", fmt::format("expected 2 or more, whose spread tells the error, found {}; "
                                                  "--shading smooth and flat take 1",
                                                  samples));
    const CLI::Option& max_samples = *app.get_option("--max-samples");
    if (max_samples.count() == 0) return;
    if (app.get_option("--until")->count() == 0)
        throw UsageError("--max-samples", "it has no effect without --until: every pixel has --samples");
    if (max_samples.as<int>() < samples)
        throw UsageError("--max-samples",
                         fmt::format("expected no less than --samples, {}, found {}", samples, max_samples.as<int>()));
}

bool has_every_pixel(const Rendering& traced) {
    return std::all_of(traced.batches.begin(), traced.batches.end(),
                       [](std::uint32_t batches) { return batches >= 2; });
}

std::vector<ImageLayer> layers_of(const Rendering& traced) {
    const PictureLayers& layers = traced.layers;
    const auto layer_of_image = [](const std::string& name, const char* channels, const Image& image) {
        static_assert(sizeof(Rgb) == 3 * sizeof(float));
        return ImageLayer{name, channels, {&image.pixels.data()->x, 3 * image.pixels.size()}};
    };
    return {layer_of_image("emitted", "RGB", layers.emitted),
            layer_of_image("direct", "RGB", layers.reflected.direct),
            layer_of_image("indirect", "RGB", layers.reflected.indirect),
            layer_of_image("albedo", "RGB", layers.albedo),
            layer_of_image("normal", "XYZ", layers.normal),
            layer_of_image("standard_error", "RGB", traced.standard_error),
            {"depth", "Z", layers.depth},
            {"element_level", "V", layers.level},
            {"direct_variance", "V", layers.reflected.direct_variance},
            {"indirect_variance", "V", layers.reflected.indirect_variance}};
}

void require_memory_for_paths(Size size) {
    require_free_memory(path_memory(0, {.width = size.width, .height = size.height}),
                        fmt::format("a picture of {} x {} pixels", size.width, size.height),
                        "a smaller --size, and --shading smooth, need less");
}

TracedPicture run_path_tracer(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                              const View& view, const PictureOptions& options, const PathTracerArguments& arguments,
                              const std::function<void(const Image&)>& on_picture) {
    require_free_memory(path_memory(scene.patches.size(), options), fmt::format("tracing paths in {}", scene.name),
                        "a smaller --size, fewer --light-walks, and a scene of fewer faces, need less");
    std::optional<PendingFile> error_image;
    if (!arguments.error_image.empty()) error_image.emplace(arguments.error_image);
    stop_on_signal();
    SharedLight shared_light(scene, solution);
    TimedRendering drawn =
        trace_with_progress(shared_light, scene, solution, ray_caster, view, options, arguments, on_picture);
    TracedPicture traced{std::move(drawn.rendering), {}};
    const bool caller_can_replace_it = solution && !arguments.has_path_outputs();
    if (caller_can_replace_it && !has_every_pixel(traced)) return traced;
    if (const auto dark = std::count(traced.batches.begin(), traced.batches.end(), 0u); dark > 0)
        spdlog::warn("{} of {} pixels were not reached before the end and are black", dark, traced.batches.size());
    if (arguments.denoise && traced.paths > 0) filter_noise(traced, *arguments.denoise);
    if (traced.interrupted) spdlog::warn("stopped early: the picture has more noise than asked for");
    log_path_tracing(options.shading, traced, drawn.seconds);
    if (error_image) write_error_image(*error_image, traced, scene, view, options);
    return traced;
}

}  // namespace interflect::command
