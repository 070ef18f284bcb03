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

void log_outcome(Shading shading, const Rendering& traced, double seconds) {
    const auto rays = static_cast<double>(traced.rays);
    spdlog::info("{}: {} paths, {} rays in {}, estimated relative error {} a pixel{}", name_of(shading),
                 magnitude(static_cast<double>(traced.paths)), magnitude(rays), duration(seconds),
                 percent(traced.relative_error),
                 traced.escaped_rays > 0 ? fmt::format(", {} of the rays left the scene",
                                                       percent(static_cast<double>(traced.escaped_rays) / rays))
                                         : "");
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
    const CLI::Option& most = *app.get_option("--max-samples");
    if (most.count() == 0) return;
    if (app.get_option("--until")->count() == 0)
        throw UsageError("--max-samples", "it has no effect without --until: every pixel has --samples");
    if (most.as<int>() < samples)
        throw UsageError("--max-samples",
                         fmt::format("expected no less than --samples, {}, found {}", samples, most.as<int>()));
}

bool has_every_pixel(const Rendering& traced) {
    return std::all_of(traced.batches.begin(), traced.batches.end(),
                       [](std::uint32_t batches) { return batches >= 2; });
}

std::vector<ImageLayer> layers_of(const Rendering& traced) {
    const PictureLayers& l = traced.layers;
    const auto of_image = [](const std::string& name, const char* channels, const Image& image) {
        static_assert(sizeof(Rgb) == 3 * sizeof(float));
        return ImageLayer{name, channels, {&image.pixels.data()->x, 3 * image.pixels.size()}};
    };
    return {of_image("emitted", "RGB", l.emitted),
            of_image("direct", "RGB", l.reflected.direct),
            of_image("indirect", "RGB", l.reflected.indirect),
            of_image("albedo", "RGB", l.albedo),
            of_image("normal", "XYZ", l.normal),
            of_image("standard_error", "RGB", traced.standard_error),
            {"depth", "Z", l.depth},
            {"element_level", "V", l.level},
            {"direct_variance", "V", l.reflected.direct_variance},
            {"indirect_variance", "V", l.reflected.indirect_variance}};
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
    TracedPicture traced;
    stop_on_signal();
    SharedLight shared_light(scene, solution);
    const double seconds = with_path_progress(shared_light, [&](Monitor monitor) {
        if (on_picture)
            monitor.on_picture = [&](const Rendering& so_far) {
                on_picture(arguments.denoise ? interflect::denoise(so_far.layers, *arguments.denoise).image
                                             : so_far.image);
            };
        static_cast<Rendering&>(traced) = solution ? render(scene, *solution, ray_caster, view, options, monitor)
                                                   : render(scene, ray_caster, view, options, monitor);
    });
    if (solution && !has_every_pixel(traced) && !arguments.has_path_outputs()) return traced;
    if (const auto dark = std::count(traced.batches.begin(), traced.batches.end(), 0u); dark > 0)
        spdlog::warn("{} of {} pixels were not reached before the end and are black", dark, traced.batches.size());
    if (arguments.denoise && traced.paths > 0) {
        const LongWork work("filtering noise");
        DenoisedPicture denoised = interflect::denoise(traced.layers, *arguments.denoise);
        traced.image = std::move(denoised.image);
        if (!denoised.standard_error.pixels.empty()) traced.standard_error = std::move(denoised.standard_error);
        traced.filter = denoised.filter;
    }
    if (traced.interrupted) spdlog::warn("stopped early: the picture has more noise than asked for");
    log_outcome(options.shading, traced, seconds);
    if (error_image) {
        const char* unit = options.quantity == PictureQuantity::irradiance ? "irradiance [lx]" : "radiance [cd/m^2]";
        write_image(*error_image, traced.standard_error,
                    {view, std::string("standard error of ") + unit, scene.name, INTERFLECT_VERSION, options.seed, 0,
                     traced.filter});
    }
    return traced;
}

}  // namespace interflect::command
