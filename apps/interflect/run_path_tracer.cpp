#include "apps/interflect/run_path_tracer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <optional>

#include "apps/interflect/percent.h"
#include "apps/interflect/progress.h"
#include "apps/interflect/signals.h"
#include "interflect/base/pending_file.h"
#include "interflect/denoise.h"
#include "interflect/error.h"
#include "interflect/gather.h"
#include "interflect/image_files.h"

namespace interflect::command {

namespace {

void log_outcome(const char* what, const PathTracing& traced, double seconds) {
    const auto rays = static_cast<double>(traced.rays);
    spdlog::info("{}: {} paths, {} rays in {}, estimated relative error {} a pixel{}", what,
                 magnitude(static_cast<double>(traced.paths)), magnitude(rays), duration(seconds),
                 percent(traced.relative_error),
                 traced.escaped_rays > 0 ? fmt::format(", {} of the rays left the scene",
                                                       percent(static_cast<double>(traced.escaped_rays) / rays))
                                         : "");
}

void require_linear_format(const std::filesystem::path& path) {
    if (needs_tone_mapping(require_image_format(path)))
        throw InputError(path, 0, "standard errors are numbers to measure with: expected .exr or .hdr");
}

}  // namespace

void PathTracerArguments::add_to(CLI::App& app) {
    app.add_option("--max-samples", max_samples, "Most paths a pixel with --until")
        ->capture_default_str()
        ->check(CLI::Range(2, 1 << 24))
        ->group(path_group);
    app.add_flag("--denoise", denoise, "Filter noise from the light, but not from textures and edges")
        ->group(path_group);
    app.add_option("--error-image", error_image, "Write the standard error of each pixel: .exr .hdr")
        ->type_name("FILE")
        ->group(path_group);
}

PathTracing run_path_tracer(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, const View& view,
                            PathOptions options, const PathTracerArguments& arguments) {
    options.max_samples = arguments.max_samples;
    std::optional<PendingFile> error_image;
    if (!arguments.error_image.empty()) {
        require_linear_format(arguments.error_image);
        error_image.emplace(arguments.error_image);
    }
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    PathTracing traced;
    {
        ProgressBar bar;
        const auto show = [&](const PathProgress& p) { bar.show({p.fraction, seconds(), p.rays, p.relative_error}); };
        const PathMonitor monitor{show, &stop_on_signal()};
        traced = solution ? gather(scene, *solution, ray_caster, view, options, monitor)
                          : trace_paths(scene, ray_caster, view, options, monitor);
    }
    if (arguments.denoise) traced.image = denoise(traced.layers);
    log_outcome(solution ? "final gathering" : "path tracing", traced, seconds());
    if (error_image) {
        write_image(*error_image, traced.standard_error,
                    {view, "standard error of radiance [cd/m^2]", scene.name, INTERFLECT_VERSION, options.seed});
    }
    return traced;
}

}  // namespace interflect::command
