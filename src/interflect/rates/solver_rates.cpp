#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/rates/embree_rates.h"
#include "interflect/solver/refinement/oracle_threshold.h"
#include "interflect/solver/sampling/ray_plan.h"
#include "interflect/solver/state/solver_state.h"
#include "interflect/solver/transport/transport.h"

namespace interflect {

using namespace detail;

namespace {

/// A step of the solver with converged light, its mesh and rays.
struct Workload {
    Workload(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options)
        : materials(scene, ray_caster),
          solution(solve(scene, ray_caster, options)),
          forest(std::const_pointer_cast<ElementForest>(solution.forest)),
          streams(options.experimental.points, options.seed) {
        if (!(channel_sum(solution.emitted_power) > 0))
            throw InputError(scene.name, 0, "the scene emits no light to measure");
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
    std::shared_ptr<ElementForest> forest;  // forest of the solution; no step refines it
    TransportStep step;
    SampleStreams streams;
    std::vector<Ray> rays;
};

/// Traces the rays in batches, as the solver does.
void trace_in_batches(const RayCaster& ray_caster, std::span<const Ray> rays) {
    constexpr std::size_t batch_rays = 1024;
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

SolverRates measure(const Scene& scene, const RayCaster& ray_caster, const Workload& work) {
    SolverRates m;
    const auto count = static_cast<double>(work.rays.size());
    m.embree = measure_embree(ray_caster, work.rays);
    Solution solution;
    const double seconds = seconds_for([&] { solution = solve(scene, ray_caster, work.solution.options); });
    m.solver = static_cast<double>(solution.iterations.back().rays) / seconds;
    // Converts the time of all prepared rays to a share of the solver's time
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

}  // namespace

SolverMeasurement measure_solver(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                                 int rounds) {
    const Workload work(scene, ray_caster, options);
    SolverMeasurement measured{.elements = work.forest->size(), .rounds = {}};
    for (int round = 0; round < rounds; ++round) measured.rounds.push_back(measure(scene, ray_caster, work));
    return measured;
}

}  // namespace interflect
