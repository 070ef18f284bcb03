#include "apps/interflect/run_path_tracer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <optional>
#include <string_view>

#include "apps/interflect/progress.h"
#include "apps/interflect/signals.h"
#include "interflect/base/error.h"
#include "interflect/base/pending_file.h"
#include "interflect/image/image_files.h"

namespace interflect::command {

namespace {

constexpr const char* path_group = "Path tracing";

bool is_given(const CLI::Option* option) { return option->count() > 0; }

void log_outcome(const PathTracing& traced, double seconds) {
    const auto rays = static_cast<double>(traced.rays);
    spdlog::info(
        "path tracing: {} paths, {} rays in {}, estimated relative error {:.2g}% a pixel{}",
        magnitude(static_cast<double>(traced.paths)), magnitude(rays), duration(seconds), 100 * traced.relative_error,
        traced.escaped_rays > 0
            ? fmt::format(", {:.2g}% of the rays left the scene", 100 * static_cast<double>(traced.escaped_rays) / rays)
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
    app.add_option("--error-image", error_image, "Write the standard error of each pixel: .exr .hdr")
        ->type_name("FILE")
        ->group(path_group);
}

void refuse_solver_options(const CLI::App& command) {
    constexpr std::array<std::string_view, 3> solver_groups = {"Solver", "Refinement", "Importance"};
    constexpr std::array<std::string_view, 2> shared = {"--seed", "--until"};
    const auto has = [](const auto& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (is_given(option) && ((has(solver_groups, option->get_group()) && !has(shared, name)) || name == "--show"))
            throw InputError(fmt::format("{}: --shading path makes no solution", name));
    }
    if (is_given(command.get_option("--max-samples")) && !is_given(command.get_option("--until")))
        throw InputError("--max-samples: without --until every pixel gets --samples");
}

void refuse_path_options(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options())
        if (option->get_group() == path_group && is_given(option))
            throw InputError(fmt::format("{}: only --shading path takes it", option->get_name()));
}

PathTracing run_path_tracer(const Scene& scene, const RayCaster& ray_caster, const View& view, PathOptions options,
                            const PathTracerArguments& arguments) {
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
        traced = trace_paths(scene, ray_caster, view, options, {show, &stop_on_signal()});
    }
    log_outcome(traced, seconds());
    if (error_image) {
        write_image(error_image->temporary_path(), traced.standard_error,
                    {view, "standard error of luminance [cd/m^2]", scene.name, INTERFLECT_VERSION, options.seed});
        error_image->commit();
    }
    return traced;
}

}  // namespace interflect::command
