#include <fmt/format.h>
#include <tbb/info.h>

#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/messages.h"
#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/rates/bench_picture.h"
#include "apps/interflect/rates/median_rates.h"
#include "apps/interflect/values/parse.h"
#include "interflect/core.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/prepare.h"
#include "interflect/rates.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::command {

using namespace detail;

namespace {

struct BenchArguments {
    SceneOptions scene;
    MeshOptions mesh;
    ViewOptions view;
    PictureBenchOptions picture;
    std::optional<Method> method;
    std::int64_t rays = 4'000'000;
    int rounds = 5, threads = 0;
    bool json = false;
};

Json figures_of(const char* method, const SolverMeasurement& measured) {
    const auto median = [&](const auto& figure) { return median_of(measured.rounds, figure); };
    return {{"method", method},
            {"elements", measured.elements},
            {"ceiling_rays_per_second", median([](const SolverRates& m) { return m.embree.ceiling(); })},
            {"embree", json_by_interface(median_rates(measured.rounds))},
            {"solver_rays_per_second", median([](const SolverRates& m) { return m.solver; })},
            {"ratio", median([](const SolverRates& m) { return m.solver / m.embree.ceiling(); })},
            {"shares_of_time",
             {{"making_rays", median([](const SolverRates& m) { return m.making_rays; })},
              {"tracing", median([](const SolverRates& m) { return m.tracing; })},
              {"receiving", median([](const SolverRates& m) { return m.receiving; })},
              {"refinement", median([](const SolverRates& m) { return m.refinement; })},
              {"sweeps", median([](const SolverRates& m) { return m.sweeps(); })}}}};
}

void print_solver(const Json& figures) {
    const auto percent_of = [&](const char* part) {
        return fmt::format("{:.0f}%", 100 * figures["shares_of_time"][part].get<double>());
    };
    fmt::print("  method                 {}, {} elements\n", figures["method"].get<std::string>(),
               figures["elements"].get<std::size_t>());
    fmt::print("  whole solver           {:8.2f} M rays/s\n", figures["solver_rays_per_second"].get<double>() / 1e6);
    fmt::print("  solver over Embree     {:8.3f}\n", figures["ratio"].get<double>());
    fmt::print(
        "  of the solver's time: {} making rays, {} tracing, {} receiving, {} refinement, {} sweeps over the "
        "elements\n",
        percent_of("making_rays"), percent_of("tracing"), percent_of("receiving"), percent_of("refinement"),
        percent_of("sweeps"));
}

void run(const BenchArguments& options, const CLI::App& command) {
    const ThreadLimit limit(options.threads);
    options.scene.check(command);
    options.view.check();
    const bool is_picture = options.picture.is_given;
    if (is_picture && options.view.count() > 1)
        throw UsageError("--view", "a picture has one view, but several were given");
    if (is_picture) require_memory_for_paths(options.picture.size);
    Scene scene = options.scene.load();
    GivenSettings given{.method = options.method, .limits = {.rays = options.rays}};
    for (const View& view : options.view.views(scene)) given.others.views.push_back({view});
    const bool needs_overview = is_picture && given.others.views.empty() && scene.views.empty();
    if (needs_overview)
        given.others.views.push_back({overview(scene)});  // replaced once rays can be traced
    else if (is_picture && given.others.views.empty())
        given.others.views.push_back({scene.views.front()});
    SolveOptions solve_options = resolved(given);
    scene = options.mesh.divide(std::move(scene), options.scene.read, solve_options.method.refines);
    const RayCaster ray_caster(scene);
    if (needs_overview) solve_options.views.front().view = overview(scene, ray_caster);

    const Json figures = is_picture ? bench_picture(scene, ray_caster, solve_options, options.picture, options.rounds)
                                    : figures_of(solve_options.method.name,
                                                 measure_solver(scene, ray_caster, solve_options, options.rounds));
    const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
    if (options.json) {
        Json json{{"scene", scene.name},
                  {"patches", scene.patches.size()},
                  {"threads", threads},
                  {"rays", options.rays},
                  {"rounds", options.rounds}};
        json.update(figures);
        json["ray_tracer_bytes"] = ray_caster.memory();
        std::cout << json_text(json, 2) << '\n';
        return;
    }
    print_line("{}: {} patches, {} threads, medians of {} rounds", scene.name, scene.patches.size(), threads,
               options.rounds);
    print_rates(figures["embree"]);
    is_picture ? print_picture(figures) : print_solver(figures);
}

}  // namespace

void add_bench(CLI::App& app) {
    const auto options = std::make_shared<BenchArguments>();
    CLI::App& command = *app.add_subcommand(
        "bench", "Measure the rays a second of the solver or a picture beside the ray tracer's own");
    options->scene.add_to(command);
    options->mesh.add_to(command);
    options->view.add_to(command);
    options->picture.add_to(command);
    add_method(command, options->method);
    add_parsed(command, "--rays", options->rays, parse_count, "Rays to solve with, and of each measurement of Embree")
        ->type_name("COUNT")
        ->default_str("4M");
    command.add_option("--rounds", options->rounds, "How often to measure; medians are reported")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    add_threads(command, options->threads);
    command.add_flag("--json", options->json, "As JSON on stdout");
    command.callback([options, &command] { run(*options, command); });
}

}  // namespace interflect::command
