// Benchmarks of the solver's main kernels: `build/release/bin/kernels`. Items per second are points, rays,
// contributions or elements. To compare two commits use bench/compare.

#include <benchmark/benchmark.h>

#include <memory>
#include <span>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/elements/forest.h"
#include "interflect/generate.h"
#include "interflect/ray_caster.h"
#include "interflect/solve.h"
#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/refinement/oracle_threshold.h"
#include "interflect/solver/sampling/probabilities.h"
#include "interflect/solver/sampling/ray_allocation.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/sampling/ray_plan.h"
#include "interflect/solver/transport/transport.h"

namespace interflect {

using namespace detail;
namespace {

constexpr std::size_t block = 1024;

void count_items(benchmark::State& state, std::size_t items_each) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items_each));
}

/// A furnished maze of nine rooms, solved with few rays, with mesh, light and importance.
struct SolvedMaze {
    Scene scene = make_maze({.rooms = 9, .furniture = true});
    Materials materials{scene};
    RayCaster ray_caster{scene};
    Solution solution = solve(scene, ray_caster, options());
    ElementForest& forest = const_cast<ElementForest&>(*solution.forest);  // does not grow further, see step()

    SolveOptions options() const {
        SolveOptions o{.method = find_method("ihsrr")};
        o.limits.rays = 2'000'000;
        o.views.push_back({scene.views.at(4)});
        return o;
    }
    TransportStep step(std::int64_t rays, bool refines) {
        TransportStep step(plan_power(materials, Emission(), solution, Radiosity(materials, solution.irradiance),
                                      importance_weights(solution, Neighbourhoods(forest)), true, rays)
                               .plan);
        if (refines) step.oracle = make_oracle(solution, solution.options.limits.rays, 1e-6);
        step.oracle.max_elements = forest.size();
        return step;
    }
};

SolvedMaze& solved_maze() {
    static const auto maze = std::make_unique<SolvedMaze>();
    return *maze;
}

void fill_a_block_of_points(benchmark::State& state) {
    PointBlock points;
    std::uint64_t first = 0;
    for (auto _ : state) {
        fill_points(static_cast<PointSet>(state.range(0)), 1, first += block, block, points);
        benchmark::DoNotOptimize(points.coordinate[3][block - 1]);
    }
    count_items(state, block);
}
BENCHMARK(fill_a_block_of_points)
    ->ArgName("pseudo_random")
    ->Arg(static_cast<int>(PointSet::sobol))
    ->Arg(static_cast<int>(PointSet::random));

void shoot_rays_from_a_patch(benchmark::State& state) {
    const SolvedMaze& m = solved_maze();
    const auto rays_each = static_cast<std::size_t>(state.range(0));
    PointBlock points;
    std::vector<Ray> rays(rays_each);
    std::vector<Parameters> origins(rays_each);
    std::uint64_t first = 0;
    for (auto _ : state) {
        shoot_rays(m.forest.geometry(PatchIndex(0)), Cell(), m.ray_caster.ray_offset(PatchIndex(0)), PointSet::sobol, 1,
                   first += rays_each, points, rays, origins);
        benchmark::DoNotOptimize(rays.back());
    }
    count_items(state, rays_each);
}
BENCHMARK(shoot_rays_from_a_patch)->ArgName("rays")->Arg(1)->Arg(8)->Arg(64)->Arg(1024);

void allocate_rays_to_elements(benchmark::State& state) {
    SolvedMaze& m = solved_maze();
    const TransportStep step = m.step(1'000'000, false);
    for (auto _ : state) benchmark::DoNotOptimize(RayAllocation(step.q, step.rays, 0.5).q_sum());
    count_items(state, step.q.size());
}
BENCHMARK(allocate_rays_to_elements);

void trace_the_solvers_rays(benchmark::State& state) {
    SolvedMaze& m = solved_maze();
    const TransportStep step = m.step(block * 64, false);
    const std::vector<Ray> rays = transport_rays(m.forest, m.ray_caster, step, SampleStreams(PointSet::sobol, 1));
    std::vector<Hit> hits(rays.size());
    for (auto _ : state) m.ray_caster.trace(rays, hits);
    count_items(state, rays.size());
}
BENCHMARK(trace_the_solvers_rays);

void add_arrivals(benchmark::State& state) {
    const auto elements = static_cast<std::uint32_t>(state.range(0));
    ContributionSums sums(elements);
    sums.begin_step(elements);
    ContributionSums::ScatterBuffer buffer(sums);
    std::uint32_t random = 1;
    for (auto _ : state) {
        const std::uint32_t payload = buffer.add_payload({1, 2, 3, 4});
        for (std::size_t i = 0; i < block; ++i) {
            random = random * 1664525u + 1013904223u;
            buffer.add(ElementIndex(std::uint64_t{random} * elements >> 32), payload,
                       ContributionSums::ScatterBuffer::Terms::both);
        }
        buffer.release_payloads();
    }
    count_items(state, block);
}
BENCHMARK(add_arrivals)->ArgName("elements")->Arg(10'000)->Arg(1'000'000);

void transport_a_million_rays(benchmark::State& state) {
    SolvedMaze& m = solved_maze();
    SampleStreams streams(PointSet::sobol, 1);
    for (auto _ : state) {
        const TransportStep step = m.step(1'000'000, state.range(0) != 0);
        benchmark::DoNotOptimize(transport(m.materials, m.forest, m.ray_caster, step, streams).shot_power);
    }
    count_items(state, 1'000'000);
}
BENCHMARK(transport_a_million_rays)->ArgName("refines")->Arg(0)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

void weigh_the_leaves(benchmark::State& state) {
    SolvedMaze& m = solved_maze();
    for (auto _ : state) benchmark::DoNotOptimize(m.step(1, false).q);
    count_items(state, m.forest.size());
}
BENCHMARK(weigh_the_leaves)->UseRealTime();

void push_and_pull(benchmark::State& state) {
    const SolvedMaze& m = solved_maze();
    std::vector<Rgb> values(m.forest.size(), Rgb(1));
    for (auto _ : state) {
        push(m.forest, values);
        pull(m.forest, values);
    }
    count_items(state, m.forest.size());
}
BENCHMARK(push_and_pull)->UseRealTime();

}  // namespace
}  // namespace interflect
