#include "interflect/solver/methods/one_bounce.h"

#include <cmath>
#include <utility>

#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/merge.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/refinement/oracle_threshold.h"

namespace interflect::detail {

namespace {

std::int64_t share_of_importance(const SolverState& state, std::int64_t rays) {
    if (importance_use(state.solution) != ImportanceUse::full) return 0;
    return std::llround(state.options.experimental.alpha * static_cast<double>(rays));
}

}  // namespace

void OneBounce::update_importance(SolverState& state, TracedIteration& iteration) {
    if (!state.options.experimental.separate_iterations) return;
    Solution& solution = state.solution;
    iteration.importance_rays = share_of_importance(state, iteration.plan.rays);
    if (iteration.importance_rays == 0) return;
    const Received received = run_step(
        state,
        TransportStep(plan_importance(state.materials, solution, importance_of(solution), iteration.importance_rays)));
    detail::merge(state, solution.indirect_importance, received.importance, iteration);
}

Estimate OneBounce::trace(SolverState& state, TracedIteration& iteration) {
    const std::int64_t rays = iteration.plan.rays - iteration.importance_rays;
    if (rays == 0) return {};
    const Solution& solution = state.solution;
    const bool combined =
        importance_use(solution) == ImportanceUse::full && !state.options.experimental.separate_iterations;
    const Radiosity light(state.materials, solution.irradiance);
    const ImportanceWeights weights =
        importance_weights(solution, state.neighbourhoods, state.emission, state.part_importance);
    PowerPlan power = plan_power(state.materials, state.emission, solution, light, weights, combined, rays);
    TransportStep step(std::move(power.plan));
    step.groups = group_radiosity(state, solution.groups);
    const bool is_deferred = state.options.experimental.defer_refinement && iteration.plan.warms_up;
    if (state.options.method.refines && !is_deferred)
        step.oracle = make_oracle(solution, state.schedule.averaged_rays() + rays, state.floor.default_min_area());
    Received received = run_step(state, std::move(step));
    state.solution.non_finite += power.non_finite_leaves;
    return {.irradiance = std::move(received.irradiance),
            .variance = std::move(received.variance),
            .groups = std::move(received.groups),
            .importance = std::move(received.importance),
            .escaped_power = received.escaped_power};
}

void OneBounce::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    Solution& solution = state.solution;
    if (!estimate.irradiance.empty()) {
        if (!iteration.plan.warms_up) estimate_noise(state, estimate, iteration.weight - iteration.importance_rays);
        detail::merge(state, solution.irradiance, estimate.irradiance, iteration);
        detail::merge(state, solution.groups, estimate.groups, iteration);
        if (!estimate.importance.empty())
            detail::merge(state, solution.indirect_importance, estimate.importance, iteration);
        merge_escaped_power(state, estimate.escaped_power, iteration);
    }
    const std::int64_t for_importance = share_of_importance(state, iteration.weight);
    state.importance_rays += for_importance;
    state.power_rays += iteration.weight - for_importance;
    update_history(state, iteration);
}

}  // namespace interflect::detail
