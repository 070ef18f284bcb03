#include "interflect/solver/methods/one_bounce.h"

#include <cmath>
#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/merge.h"
#include "interflect/solver/radiosity.h"
#include "interflect/solver/transport_steps.h"

namespace interflect::inline detail {

RgbD OneBounce::iterate(SolverState& state, IterationPlan& plan) {
    Solution& solution = state.solution;
    const bool with_importance = importance_use(solution) == ImportanceUse::full;
    const bool combined = with_importance && !state.options.experimental.separate_iterations;
    const std::int64_t for_importance =
        with_importance ? std::llround(state.options.experimental.alpha * static_cast<double>(plan.rays)) : 0;
    const std::uint32_t elements_before = state.forest->size();
    if (with_importance && !combined && for_importance > 0) {
        const Received received =
            run_step(state, importance_step(state.materials, solution, importance_of(solution), for_importance));
        merge(state, solution.indirect_importance, received.importance, plan);
    }
    const std::int64_t rays = combined ? plan.rays : plan.rays - for_importance;
    if (rays > 0) {
        const Radiosity light(state.materials, solution.irradiance);
        const ImportanceWeights weights =
            importance_weights(solution, state.neighbourhoods, state.emission, state.part_importance);
        auto [step, power, weighted_power, lost_leaves] =
            power_step(state.materials, state.emission, solution, light, weights, combined, rays);
        step.groups = group_radiosity(state, solution.groups);
        const bool deferred = state.options.experimental.defer_refinement && plan.warms_up;
        if (state.options.method.refines && !deferred)
            step.oracle = make_oracle(solution, state.schedule.averaged_rays() + rays, state.floor.unseen());
        Received received = run_step(state, std::move(step));
        solution.non_finite += lost_leaves;
        const FreshEstimate fresh{std::move(received.irradiance), std::move(received.variance),
                                  std::move(received.groups)};
        if (!plan.warms_up) estimate_noise(state, fresh, rays);
        merge(state, solution.irradiance, fresh.irradiance, plan);
        merge(state, solution.groups, fresh.groups, plan);
        if (combined) merge(state, solution.indirect_importance, received.importance, plan);
        merge_escaped_power(state, received.escaped_power, plan);
    }
    state.importance_rays += for_importance;
    state.power_rays += plan.rays - for_importance;
    update_history(state, plan, elements_before);
    return state.escaped_power;
}

}  // namespace interflect::inline detail
