#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/messages.h"
#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/rates/bench_picture.h"
#include "apps/interflect/rates/embree_rates.h"
#include "apps/interflect/values/parse.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/ray_caster.h"
#include "interflect/scene/core/view.h"
#include "interflect/solve.h"
#include "interflect/solver/refinement/oracle_threshold.h"
#include "interflect/solver/sampling/ray_plan.h"
#include "interflect/solver/state/solver_state.h"
#include "interflect/solver/transport/transport.h"

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

/// A step of the solver with converged light, its mesh and rays.
struct Workload {
    Workload(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options)
        : materials(scene, ray_caster),
          solution(solve(scene, ray_caster, options)),
          forest(std::const_pointer_cast<ElementForest>(solution.forest)),
          streams(options.experimental.points, options.seed) {
        if (!(channel_sum(solution.emitted_power) > 0))
            throw InputError(scene.name, 0, "nothing in the scene emits light: there is nothing to measure");
        const bool combined = importance_use(solution) == ImportanceUse::full;
        const Radiosity light(materials, solution.irradiance);
        const ImportanceWeights weights = importance_weights(solution, Neighbourhoods(*forest));
        step = TransportStep(
            plan_power(materials, Emission(), solution, light, weights, combined, options.limits.rays).plan);
        step.importance_at_patches = options.experimental.importance_at_patches;
        if (options.method.refines && !refines_by_variance(options))
            step.oracle = make_oracle(solution, options.limits.rays, options.refinement.min_area);
        step.oracle.max_elements = forest->size();
        rays = transport_rays(*forest, ray_caster, step, streams);
    }
    Workload(const Workload&) = delete;  // the step refers to it
    Workload& operator=(const Workload&) = delete;

    Materials materials;
    Solution solution;
    std::shared_ptr<ElementForest> forest;  // the solution's; no step refines it
    TransportStep step;
    SampleStreams streams;
    std::vector<Ray> rays;
};

struct Measurement {
    EmbreeRates embree;  // of one round
    double solver = 0;   // [rays/s]
    // Shares of the solver's time, each measured alone: generating rays, tracing, finding the hit leaves, and choosing
    // elements with the oracle. The rest is work per element of every iteration.
    double making_rays = 0, tracing = 0, receiving = 0, refinement = 0;

    double sweeps() const { return std::max(0.0, 1 - making_rays - tracing - receiving - refinement); }
};

/// Traces batches, as the solver does.
void trace_in_batches(const RayCaster& ray_caster, std::span<const Ray> rays) {
    constexpr std::size_t batch_rays = 4096;
    parallel_for_ranges(rays.size(), batch_rays, [&](std::size_t begin, std::size_t end) {
        std::array<Hit, batch_rays> hits;
        ray_caster.trace(rays.subspan(begin, end - begin), std::span(hits).first(end - begin));
    });
}

/// Runs a step of transport without refinement.
void repeat_step(const RayCaster& ray_caster, const Workload& work, bool with_oracle) {
    TransportStep step = work.step;
    step.oracle.refines = with_oracle && work.step.oracle.refines;
    SampleStreams streams = work.streams;
    transport(work.materials, *work.forest, ray_caster, std::move(step), streams);
}

/// Measures everything in one run, since a machine's speed changes with its load.
Measurement measure(const Scene& scene, const RayCaster& ray_caster, const Workload& work) {
    Measurement m;
    const auto count = static_cast<double>(work.rays.size());
    m.embree = measure_embree(ray_caster, work.rays);
    Solution solution;
    const double seconds = seconds_for([&] { solution = solve(scene, ray_caster, work.solution.options); });
    m.solver = static_cast<double>(solution.iterations.back().rays) / seconds;
    const auto share = [&](double seconds_for_count) { return seconds_for_count / count * m.solver; };
    m.making_rays =
        share(seconds_for([&] { transport_rays(*work.solution.forest, ray_caster, work.step, work.streams); }));
    m.tracing = share(seconds_for([&] { trace_in_batches(ray_caster, work.rays); }));
    const double whole_step = share(seconds_for([&] { repeat_step(ray_caster, work, true); }));
    const double without_oracle = share(seconds_for([&] { repeat_step(ray_caster, work, false); }));
    m.receiving = std::max(0.0, without_oracle - m.making_rays - m.tracing);
    m.refinement = std::max(0.0, whole_step - without_oracle);
    return m;
}

Json figures_of(const Workload& work, const std::vector<Measurement>& rounds) {
    const auto median = [&](const auto& figure) { return median_of(rounds, figure); };
    return {{"method", work.solution.options.method.name},
            {"elements", work.solution.forest->size()},
            {"ceiling_rays_per_second", median([](const Measurement& m) { return m.embree.ceiling(); })},
            {"embree", json_by_interface(median_rates(rounds))},
            {"solver_rays_per_second", median([](const Measurement& m) { return m.solver; })},
            {"ratio", median([](const Measurement& m) { return m.solver / m.embree.ceiling(); })},
            {"shares_of_time",
             {{"making_rays", median([](const Measurement& m) { return m.making_rays; })},
              {"tracing", median([](const Measurement& m) { return m.tracing; })},
              {"receiving", median([](const Measurement& m) { return m.receiving; })},
              {"refinement", median([](const Measurement& m) { return m.refinement; })},
              {"sweeps", median([](const Measurement& m) { return m.sweeps(); })}}}};
}

Json bench_solver(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& solve_options, int rounds) {
    const Workload work(scene, ray_caster, solve_options);
    std::vector<Measurement> measured;
    measured.reserve(static_cast<std::size_t>(rounds));
    for (int round = 0; round < rounds; ++round) measured.push_back(measure(scene, ray_caster, work));
    return figures_of(work, measured);
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
    if (is_picture && given.others.views.empty())
        given.others.views.push_back({scene.views.empty() ? overview(scene) : scene.views.front()});
    const SolveOptions solve_options = resolved(given);
    scene = options.mesh.divide(std::move(scene), options.scene.read, solve_options.method.refines);
    const RayCaster ray_caster(scene);

    const Json figures = is_picture ? bench_picture(scene, ray_caster, solve_options, options.picture, options.rounds)
                                    : bench_solver(scene, ray_caster, solve_options, options.rounds);
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
