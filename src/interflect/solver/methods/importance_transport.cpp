#include "interflect/solver/methods/importance_transport.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/methods/bounce_budget.h"

namespace interflect::detail {

namespace {

/// The transport ends when this share of the importance is unshot.
constexpr double negligible_importance = 0.005;
/// Maximum expected ratio of the importance of two successive bounces, as in BounceBudget.
constexpr double most_received_again = 0.99;

}  // namespace

void transport_importance(SolverState& state, std::int64_t rays) {
    Solution& solution = state.light.solution;
    std::vector<float> unshot = solution.view_importance;
    BounceBudget budget(rays, 0);
    const std::int64_t rays_before = state.rays.importance;
    double unshot_sum = 1;  // importance received in the last bounce; initially all of V
    double decay = 0;       // ratio of unshot_sum to its value in the bounce before
    while (unshot_sum > negligible_importance && !budget.has_planned_last_bounce()) {
        TransportStep step(plan_importance(state.inputs.materials, solution, Importance(unshot),
                                           std::max<std::int64_t>(1, budget.next(unshot_sum).expected)));
        state.rays.importance += step.rays;
        unshot = run_step(state, std::move(step)).importance;
        const double before = std::exchange(unshot_sum, 0);
        for (ElementIndex e{0}; e < state.light.forest->size(); ++e) {
            solution.indirect_importance[e] += unshot[e];
            if (e < state.light.forest->patch_count())
                unshot_sum += static_cast<double>(unshot[e]) * state.light.forest->area(e);
        }
        decay = std::min(most_received_again, unshot_sum / before);
    }
    // Estimate the untraced bounces as a geometric series with the distribution of the last bounce.
    const auto rest = static_cast<float>(decay / (1 - decay));
    for (ElementIndex e{0}; e < state.light.forest->size() && rest > 0; ++e)
        solution.indirect_importance[e] += rest * unshot[e];
    state.rays.of_first_importance = state.rays.importance - rays_before;
}

}  // namespace interflect::detail
