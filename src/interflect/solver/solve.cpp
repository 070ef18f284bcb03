#include "interflect/solver/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/link_radiosity.h"
#include "interflect/solver/merge.h"
#include "interflect/solver/passes.h"
#include "interflect/solver/radiosity.h"
#include "interflect/solver/random_walk.h"
#include "interflect/solver/solver_state.h"
#include "interflect/solver/steps.h"
#include "interflect/solver/well_distributed.h"

namespace interflect {

namespace {

void require_valid(const Scene& scene, const SolveOptions& o) {
    std::vector<std::string> faults = scene_faults(scene);
    const auto require = [&](bool holds, const std::string& message) {
        if (!holds) faults.push_back(message);
    };
    require(!scene.patches.empty(), "the scene has no patches");
    require(o.rays > 0, "rays: expected more than 0");
    require(o.seconds > 0, "seconds: expected more than 0");
    require(o.until >= 0 && o.until < 1, "until: expected a relative error from 0 to below 1");
    require(o.warm_up >= 0, "warm_up: expected 0 or more");
    require(o.iterations >= 0, "iterations: expected 0 or more");
    require(o.rays_per_iteration >= 0 && o.rays_per_iteration <= most_rays_per_iteration,
            "rays_per_iteration: expected 0 to 100 thousand million");
    require(o.epsilon > 0, "epsilon: expected more than 0");
    require(o.epsilon_decay >= 0 && o.epsilon_decay <= 1, "epsilon_decay: expected 0 to 1");
    require(o.min_area >= 0, "min_area: expected 0 or more");
    require(o.max_elements >= scene.patches.size() && o.max_elements < 0xfffffff0u,
            fmt::format("max_elements: {}, expected at least the number of patches, {}, and less than 2^32 - 16",
                        o.max_elements, scene.patches.size()));
    require(o.alpha >= 0 && o.alpha <= 1, "alpha: expected 0 to 1");
    require(o.beta >= 0 && o.beta <= 1, "beta: expected 0 to 1");
    require(o.inherited_weight >= 0 && o.inherited_weight <= 1, "inherited_weight: expected 0 to 1");
    require(o.importance_smoothing >= 0 && o.importance_smoothing <= 1, "importance_smoothing: expected 0 to 1");
    require(o.importance_exponent >= 0 && o.importance_exponent <= 1, "importance_exponent: expected 0 to 1");
    require(o.camera_rays > 0 && o.camera_rays <= most_camera_rays, "camera_rays: expected 1 to 2^22");
    for (const WeightedView& v : o.views)
        require(v.weight > 0 && std::isfinite(v.weight) && v.aspect > 0 && std::isfinite(v.aspect) && v.pixel_rows > 0,
                "view '" + v.view.name + "': weight, aspect and pixel_rows: expected finite numbers above 0");
    require(o.method.scheme != Scheme::well_distributed || o.method.importance == ImportanceUse::off,
            "importance: a method that keeps every ray needs rays of equal power, which importance does not give");
    require_no_faults(faults, "cannot solve", scene);
}

/// One iteration: what is received in one bounce of the present estimate, merged with the running mean.
/// @return The power that left the scene.
RgbD iterate(SolverState& state, IterationPlan& plan) {
    Solution& solution = state.solution;
    const std::uint32_t elements_before = state.forest->size();
    const bool with_importance = importance_use(solution) == ImportanceUse::full;
    const bool combined = with_importance && !state.options.separate_iterations;
    const std::int64_t for_importance =
        with_importance ? std::llround(state.options.alpha * static_cast<double>(plan.rays)) : 0;
    state.importance_rays += for_importance;
    state.power_rays += plan.rays - for_importance;
    if (with_importance && !combined && for_importance > 0) {
        const Received received =
            run_step(state, importance_step(state.materials, solution, importance_of(solution), for_importance));
        merge(state, solution.indirect_importance, received.importance, plan);
    }
    RgbD escaped_power(0, 0, 0);
    const std::int64_t rays = combined ? plan.rays : plan.rays - for_importance;
    if (rays > 0) {
        const Radiosity light(state.materials, solution.irradiance);
        const ImportanceWeights weights = importance_weights(solution, state.neighbourhoods);
        TransportStep step = power_step(state.materials, solution, light, weights, combined, rays).step;
        const bool deferred = state.options.defer_refinement && plan.warms_up;
        if (state.options.method.refines && !deferred)
            step.oracle = make_oracle(solution, state.schedule.averaged_rays() + rays, state.floor.unseen());
        Received received = run_step(state, std::move(step));
        const FreshEstimate fresh{std::move(received.irradiance), std::move(received.variance)};
        if (!plan.warms_up) estimate_noise(state, fresh, rays);
        merge(state, solution.irradiance, fresh.irradiance, plan);
        if (combined) merge(state, solution.indirect_importance, received.importance, plan);
        escaped_power = received.escaped_power;
    }
    update_history(state, plan, elements_before);
    return escaped_power;
}

bool reached(const SolverState& state) {
    const std::vector<IterationReport>& reports = state.solution.iterations;
    return !reports.empty() && reports.back().error_estimate <= state.options.until;
}

/// One iteration of so many rays; it may change their number. @return The power that left the scene.
using Iteration = std::function<RgbD(SolverState&, IterationPlan&)>;

/// Makes what iterations begin with, and how each of them is done.
Iteration begin_iterations(SolverState& state) {
    const bool by_passes = state.options.complete_passes;
    switch (state.options.method.scheme) {
        case Scheme::well_distributed:
            if (by_passes) make_first_estimate(state);
            return [rays = WellDistributedRays(state)](SolverState& s, IterationPlan& plan) mutable {
                return rays.iterate(s, plan);
            };
        case Scheme::random_walk:
            return [walks = RandomWalks(state)](SolverState& s, IterationPlan& plan) mutable {
                return walks.iterate(s, plan);
            };
        default:
            if (!by_passes) return iterate;
            return [passes = prepare_passes(state)](SolverState& s, IterationPlan& plan) mutable {
                return iterate_pass(s, passes, plan);
            };
    }
}

/// @throws Interrupted in the middle of an iteration.
void iterate_until_done(SolverState& state) {
    const Iteration iterate_once = begin_iterations(state);
    state.stop.limit_time(state.start, state.options.seconds);
    for (int iteration = 1; !reached(state); ++iteration) {
        IterationPlan plan = state.schedule.next(state.seconds());
        if (plan.rays == 0) return;
        refine_view_importance(state);
        const RgbD escaped_power = iterate_once(state, plan);
        state.schedule.done(plan);
        report(state, iteration, escaped_power);
    }
}

Solution solve_by_iterations(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                             const Monitor& monitor) {
    SolverState state(scene, ray_caster, options, monitor);
    const bool is_lit = channel_sum(state.solution.emitted_power) > 0;  // else it is dark, and exactly so
    try {
        if (is_lit) iterate_until_done(state);
    } catch (const Interrupted&) {
        state.solution.interrupted = state.stop.is_asked_for();
    }
    finish_solution(state);
    return std::move(state.solution);
}

}  // namespace

const Method& find_method(const std::string& name) {
    std::string known;
    for (const Method& method : methods) {
        if (name == method.name) return method;
        known += (known.empty() ? "" : ", ") + std::string(method.name);
    }
    throw InputError("there is no method '" + name + "'; there are: " + known);
}

Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options, const Monitor& monitor) {
    require_valid(scene, options);
    ray_caster.require_made_for(scene);
    if (options.method.scheme == Scheme::links) return solve_by_links(scene, ray_caster, options, monitor);
    return solve_by_iterations(scene, ray_caster, options, monitor);
}

}  // namespace interflect
