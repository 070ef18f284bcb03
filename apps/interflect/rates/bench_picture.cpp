#include "apps/interflect/rates/bench_picture.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/interflect/rates/median_rates.h"
#include "interflect/core.h"
#include "interflect/rates.h"
#include "interflect/solve.h"

namespace interflect::command {

using namespace detail;

void PictureBenchOptions::add_to(CLI::App& command) {
    CLI::Option* picture = command.add_flag("--picture", is_given, "Measure a picture instead of the solver");
    std::vector<std::pair<std::string, Shading>> choices;
    for (const Shading choice : available_shadings(&DefaultSamples::pixel))
        if (traces_paths(choice)) choices.emplace_back(label(choice), choice);
    add_choice<Shading>(command, "--shading", shading, choices, "Shading of the picture, as of render")
        ->default_str(label(shading))
        ->needs(picture);
    add_parsed(command, "--size", size, parse_size, "Picture size in pixels")
        ->type_name("WxH")
        ->default_str("640x360")
        ->needs(picture);
    command.add_option("--samples", samples, "Camera rays a pixel of the picture (default: as of render)")
        ->check(CLI::Range(2, 65536))
        ->needs(picture);
}

Json bench_picture(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& solve_options,
                   const PictureBenchOptions& options, int rounds) {
    std::optional<Solution> solution;
    if (needs_solution(options.shading)) solution = solve(scene, ray_caster, solve_options);
    const PictureOptions picture{.width = options.size.width,
                                 .height = options.size.height,
                                 .shading = options.shading,
                                 .samples = require_samples(options.shading, &DefaultSamples::pixel, options.samples)};
    const View& view = solve_options.views.front().view;
    const PictureMeasurement measured = measure_picture(scene, solution ? &*solution : nullptr, ray_caster, view,
                                                        picture, solve_options.limits.rays, rounds);
    using Round = PictureMeasurement::Round;
    const auto median = [&](const auto& figure) { return median_of(measured.rounds, figure); };
    const auto rays = static_cast<double>(measured.rays);
    const auto rate = [&](const Round& round) { return rays / round.seconds; };
    return {{"shading", label(options.shading)},
            {"width", options.size.width},
            {"height", options.size.height},
            {"samples", picture.samples},
            {"picture_rays", rays},
            {"shares_of_rays",
             {{"camera", measured.camera}, {"reflected", measured.reflected}, {"shadow", measured.shadow}}},
            {"recorded_rays", measured.recorded},
            {"seconds", median([](const Round& round) { return round.seconds; })},
            {"ceiling_rays_per_second", median([](const Round& round) { return round.embree.ceiling(); })},
            {"embree", json_by_interface(median_rates(measured.rounds))},
            {"picture_rays_per_second", median(rate)},
            {"ratio", median([&](const Round& round) { return rate(round) / round.embree.ceiling(); })}};
}

void print_picture(const Json& figures) {
    const auto number = [&](const char* name) { return figures[name].get<double>(); };
    const auto percent_of = [&](const char* kind) {
        return fmt::format("{:.0f}%", 100 * figures["shares_of_rays"][kind].get<double>());
    };
    fmt::print("  whole picture          {:8.2f} M rays/s\n", number("picture_rays_per_second") / 1e6);
    fmt::print("  picture over Embree    {:8.3f}\n", number("ratio"));
    fmt::print("  {} x {} pixels of {} samples, {} shading: {:.3g} s\n", figures["width"].get<int>(),
               figures["height"].get<int>(), figures["samples"].get<int>(), figures["shading"].get<std::string>(),
               number("seconds"));
    fmt::print("  of {:.1f} M rays: {} from the camera, {} reflected, {} to lights\n", number("picture_rays") / 1e6,
               percent_of("camera"), percent_of("reflected"), percent_of("shadow"));
}

}  // namespace interflect::command
