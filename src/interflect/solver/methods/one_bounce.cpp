#include "interflect/solver/methods/one_bounce.h"

#include <cmath>
#include <utility>

#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/merge.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/refinement/oracle_threshold.h"

namespace interflect::detail {

namespace {

std::int64_t share_of_importance(const LightState& light, std::int64_t rays) {
    if (importance_use(light.solution) != ImportanceUse::full) return 0;
    return std::llround(light.options().experimental.alpha * static_cast<double>(rays));
}

}  // namespace

void OneBounce::update_importance(SolverState& state, TracedIteration& iteration) {
    if (!state.light.options().experimental.separate_iterations) return;
    Solution& solution = state.light.solution;
    iteration.importance_rays = share_of_importance(state.light, iteration.plan.rays);
    if (iteration.importance_rays == 0) return;
    const Received received =
        run_step(state, TransportStep(plan_importance(state.inputs.materials, solution, importance_of(solution),
                                                      iteration.importance_rays)));
    merge_importance(state.light, state.rays, received.importance, iteration);
}

Estimate OneBounce::trace(SolverState& state, TracedIteration& iteration) {
    const std::int64_t rays = iteration.plan.rays - iteration.importance_rays;
    if (rays == 0) return {};
    const Solution& solution = state.light.solution;
    const bool combined =
        importance_use(solution) == ImportanceUse::full && !state.light.options().experimental.separate_iterations;
    const Radiosity light(state.inputs.materials, solution.irradiance);
    const ImportanceWeights weights = importance_weights(solution, state.sampling.neighbourhoods, state.inputs.emission,
                                                         state.sampling.part_importance);
    PowerPlan power =
        plan_power(state.inputs.materials, state.inputs.emission, solution, light, weights, combined, rays);
    TransportStep step(std::move(power.plan));
    step.groups = group_radiosity(state.inputs, state.light, solution.groups);
    const bool is_deferred = state.light.options().experimental.defer_refinement && iteration.plan.warms_up;
    if (state.light.options().method.refines && !is_deferred)
        step.oracle = make_oracle(solution, state.rays.schedule.averaged_rays() + rays,
                                  state.inputs.element_floor.default_min_area());
    Received received = run_step(state, std::move(step));
    state.light.solution.non_finite += power.non_finite_leaves;
    return {.irradiance = std::move(received.irradiance),
            .variance = std::move(received.variance),
            .groups = std::move(received.groups),
            .importance = std::move(received.importance),
            .escaped_power = received.escaped_power};
}

void OneBounce::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    Solution& solution = state.light.solution;
    if (!estimate.irradiance.empty()) {
        if (!iteration.plan.warms_up) estimate_noise(state, estimate, iteration.weight - iteration.importance_rays);
        detail::merge(state.light, solution.irradiance, estimate.irradiance, iteration);
        detail::merge(state.light, solution.groups, estimate.groups, iteration);
        if (!estimate.importance.empty()) merge_importance(state.light, state.rays, estimate.importance, iteration);
        merge_escaped_power(state.light, estimate.escaped_power, iteration);
    }
    const std::int64_t for_importance = share_of_importance(state.light, iteration.weight);
    state.rays.importance += for_importance;
    state.rays.power += iteration.weight - for_importance;
    update_history(state.light, iteration);
}

}  // namespace interflect::detail
