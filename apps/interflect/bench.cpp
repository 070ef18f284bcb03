#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "apps/interflect/commands.h"
#include "apps/interflect/parse.h"
#include "apps/interflect/shared_options.h"
#include "apps/interflect/threads.h"
#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/solver/solve.h"
#include "interflect/solver/steps.h"
#include "interflect/solver/transport.h"

namespace interflect::command {

namespace {

using Json = nlohmann::ordered_json;
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

/// What the solver traces when the light has already spread through the scene and the mesh is there.
struct Workload {
    Surfaces surfaces;
    Solution solution;
    TransportStep step;
    SampleStreams streams;
    std::vector<Ray> rays;
};

Workload typical_workload(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options) {
    Workload work{Surfaces(scene), solve(scene, ray_caster, options), {}, {options.points, options.seed}, {}};
    if (!(channel_sum(work.solution.emitted_power) > 0))
        throw InputError(scene.name, 0, "nothing in the scene emits light: there is nothing to measure");
    const Light light(work.surfaces, work.solution.irradiance);
    const bool combined = importance_use(work.solution) == ImportanceUse::full;
    work.step = power_step(work.surfaces, work.solution, light, combined, options.rays);
    work.rays = transport_rays(*work.solution.forest, ray_caster, work.step, work.streams);
    return work;
}

struct Measurement {
    double ceiling = 0, solver = 0;                  // [rays/s], of one round
    std::array<double, interfaces.size()> embree{};  // [rays/s], each interface
    double making_rays = 0, tracing = 0;             // each alone; shares of the solver's time
};

/// Traces as the solver does: batches of rays, which become hits.
void trace_in_batches(const RayCaster& ray_caster, std::span<const Ray> rays) {
    constexpr std::size_t batch_rays = 4096;
    parallel_for_ranges(rays.size(), batch_rays, [&](std::size_t begin, std::size_t end) {
        std::array<Hit, batch_rays> hits;
        ray_caster.trace(rays.subspan(begin, end - begin), std::span(hits).first(end - begin));
    });
}

/// Everything in one run, one after the other, since the speed of a machine changes with its load.
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
    return m;
}

void run(const BenchArguments& options) {
    const ThreadLimit limit(options.threads);
    Scene scene = options.scene.load();
    SolveOptions solve_options;
    solve_options.rays = options.rays;
    for (const View& view : options.view.views(scene)) solve_options.views.push_back({view});
    solve_options.method = options.method.value_or(find_method(solve_options.views.empty() ? "hsrr" : "ihsrr"));
    scene = options.mesh.divide(std::move(scene), options.scene.read, solve_options.method.refines);
    const RayCaster ray_caster(scene);
    const Workload work = typical_workload(scene, ray_caster, solve_options);

    std::vector<double> ratios, ceilings, solvers, making_rays, tracing;
    std::array<std::vector<double>, interfaces.size()> embree;
    for (int round = 0; round < options.rounds; ++round) {
        const Measurement m = measure(scene, ray_caster, work);
        ratios.push_back(m.solver / m.ceiling);
        ceilings.push_back(m.ceiling);
        solvers.push_back(m.solver);
        making_rays.push_back(m.making_rays);
        tracing.push_back(m.tracing);
        for (std::size_t i = 0; i < interfaces.size(); ++i) embree[i].push_back(m.embree[i]);
    }

    const double making_share = median(making_rays), tracing_share = median(tracing);
    const double rest = std::max(0.0, 1 - making_share - tracing_share);
    const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
    if (options.json) {
        Json by_interface;
        for (std::size_t i = 0; i < interfaces.size(); ++i) by_interface[interfaces[i].second] = median(embree[i]);
        const Json shares{{"making_rays", making_share}, {"tracing", tracing_share}, {"rest", rest}};
        const Json result{{"scene", scene.name},
                          {"patches", scene.patches.size()},
                          {"method", solve_options.method.name},
                          {"elements", work.solution.forest->size()},
                          {"threads", threads},
                          {"rays", options.rays},
                          {"rounds", options.rounds},
                          {"ceiling_rays_per_second", median(ceilings)},
                          {"embree", by_interface},
                          {"solver_rays_per_second", median(solvers)},
                          {"ratio", median(ratios)},
                          {"shares_of_time", shares},
                          {"ray_tracer_bytes", ray_caster.memory()}};
        std::cout << result.dump(2) << '\n';
        return;
    }
    fmt::print("{}, {}: {} patches, {} elements, {} threads, medians of {} rounds\n", scene.name,
               solve_options.method.name, scene.patches.size(), work.solution.forest->size(), threads, options.rounds);
    for (std::size_t i = 0; i < interfaces.size(); ++i)
        fmt::print("  Embree alone, {:9}{:8.2f} M rays/s\n", interfaces[i].second, median(embree[i]) / 1e6);
    fmt::print("  whole solver          {:8.2f} M rays/s\n", median(solvers) / 1e6);
    fmt::print("  solver over Embree    {:8.3f}\n", median(ratios));
    fmt::print("  of the solver's time  {:.0f}% making rays, {:.0f}% tracing, {:.0f}% the rest\n", 100 * making_share,
               100 * tracing_share, 100 * rest);
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
    command.callback([options] { run(*options); });
}

}  // namespace interflect::command
