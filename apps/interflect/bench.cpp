#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "apps/interflect/commands.h"
#include "apps/interflect/messages.h"
#include "apps/interflect/parse.h"
#include "apps/interflect/shared_options.h"
#include "apps/interflect/threads.h"
#include "interflect/base/parallel.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/prepared_rays.h"
#include "interflect/solve.h"
#include "interflect/solver/refinement/oracle_threshold.h"
#include "interflect/solver/sampling/ray_plan.h"
#include "interflect/solver/state/solver_state.h"
#include "interflect/solver/transport/transport.h"

namespace interflect::command {

using namespace detail;

namespace {

using Clock = std::chrono::steady_clock;

struct BenchArguments {
    SceneOptions scene;
    MeshOptions mesh;
    ViewOptions view;
    std::optional<Method> method;
    std::int64_t rays = 4'000'000;
    int rounds = 5, threads = 0;
    bool json = false;
};

constexpr std::array<std::pair<RayInterface, const char*>, 4> interfaces = {{{RayInterface::single, "single"},
                                                                             {RayInterface::packet8, "packet8"},
                                                                             {RayInterface::packet16, "packet16"},
                                                                             {RayInterface::stream, "stream"}}};

template <class Work>
double seconds_for(const Work& work) {
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

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
        const ImportanceWeights weights =
            importance_weights(solution, Neighbourhoods(*forest), solution.iterations.back().importance_rays);
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
    double ceiling = 0, solver = 0;                  // [rays/s], of one round
    std::array<double, interfaces.size()> embree{};  // [rays/s], per interface
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
    for (std::size_t i = 0; i < interfaces.size(); ++i) {
        PreparedRays prepared(work.rays, interfaces[i].first);
        m.embree[i] = count / seconds_for([&] {
                          parallel_for_ranges(prepared.group_count(), 1, [&](std::size_t group, std::size_t) {
                              prepared.trace_group(ray_caster, group);
                          });
                      });
    }
    m.ceiling = *std::max_element(m.embree.begin(), m.embree.end());
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

struct BenchResult {
    explicit BenchResult(const std::vector<Measurement>& rounds) {
        const auto median_of = [&](const auto& figure) {
            std::vector<double> values(rounds.size());
            std::transform(rounds.begin(), rounds.end(), values.begin(), figure);
            return median(values);
        };
        ratio = median_of([](const Measurement& m) { return m.solver / m.ceiling; });
        ceiling = median_of([](const Measurement& m) { return m.ceiling; });
        solver = median_of([](const Measurement& m) { return m.solver; });
        for (std::size_t i = 0; i < interfaces.size(); ++i)
            embree[i] = median_of([i](const Measurement& m) { return m.embree[i]; });
        shares = {{{"making_rays", median_of([](const Measurement& m) { return m.making_rays; })},
                   {"tracing", median_of([](const Measurement& m) { return m.tracing; })},
                   {"receiving", median_of([](const Measurement& m) { return m.receiving; })},
                   {"refinement", median_of([](const Measurement& m) { return m.refinement; })},
                   {"sweeps", median_of([](const Measurement& m) { return m.sweeps(); })}}};
    }

    double ratio, ceiling, solver;  // solver / ceiling; [rays/s]
    std::array<double, interfaces.size()> embree;
    std::array<std::pair<const char*, double>, 5> shares;  // of the solver's time
};

Json figures_of(const BenchResult& result) {
    Json by_interface;
    for (std::size_t i = 0; i < interfaces.size(); ++i) by_interface[interfaces[i].second] = result.embree[i];
    Json shares_of_time;
    for (const auto& [name, share] : result.shares) shares_of_time[name] = share;
    return {{"ceiling_rays_per_second", result.ceiling},
            {"embree", by_interface},
            {"solver_rays_per_second", result.solver},
            {"ratio", result.ratio},
            {"shares_of_time", shares_of_time}};
}

void print_figures(const BenchResult& result) {
    for (std::size_t i = 0; i < interfaces.size(); ++i)
        fmt::print("  Embree alone, {:9}{:8.2f} M rays/s\n", interfaces[i].second, result.embree[i] / 1e6);
    fmt::print("  whole solver          {:8.2f} M rays/s\n", result.solver / 1e6);
    fmt::print("  solver over Embree    {:8.3f}\n", result.ratio);
    fmt::print(
        "  of the solver's time  {:.0f}% making rays, {:.0f}% tracing, {:.0f}% receiving, {:.0f}% refinement, "
        "{:.0f}% sweeps over the elements\n",
        100 * result.shares[0].second, 100 * result.shares[1].second, 100 * result.shares[2].second,
        100 * result.shares[3].second, 100 * result.shares[4].second);
}

void run(const BenchArguments& options, const CLI::App& command) {
    const ThreadLimit limit(options.threads);
    options.scene.check(command);
    options.view.check();
    Scene scene = options.scene.load();
    SolveOptions solve_options;
    solve_options.limits.rays = options.rays;
    for (const View& view : options.view.views(scene)) solve_options.views.push_back({view});
    solve_options.method = options.method.value_or(default_method(!solve_options.views.empty()));
    scene = options.mesh.divide(std::move(scene), options.scene.read, solve_options.method.refines);
    const RayCaster ray_caster(scene);
    const Workload work(scene, ray_caster, solve_options);

    std::vector<Measurement> rounds;
    rounds.reserve(static_cast<std::size_t>(options.rounds));
    for (int round = 0; round < options.rounds; ++round) rounds.push_back(measure(scene, ray_caster, work));
    const BenchResult result(rounds);

    const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
    if (options.json) {
        Json json{{"scene", scene.name},
                  {"patches", scene.patches.size()},
                  {"method", solve_options.method.name},
                  {"elements", work.solution.forest->size()},
                  {"threads", threads},
                  {"rays", options.rays},
                  {"rounds", options.rounds}};
        json.update(figures_of(result));
        json["ray_tracer_bytes"] = ray_caster.memory();
        std::cout << json_text(json, 2) << '\n';
        return;
    }
    print_line("{}, {}: {} patches, {} elements, {} threads, medians of {} rounds", scene.name,
               solve_options.method.name, scene.patches.size(), work.solution.forest->size(), threads, options.rounds);
    print_figures(result);
}

}  // namespace

void add_bench(CLI::App& app) {
    const auto options = std::make_shared<BenchArguments>();
    CLI::App& command = *app.add_subcommand("bench", "Measure the solver's rays a second beside the ray tracer's own");
    options->scene.add_to(command);
    options->mesh.add_to(command);
    options->view.add_to(command);
    add_method(command, options->method);
    add_parsed(command, "--rays", options->rays, parse_count, "Rays of each measurement")
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
