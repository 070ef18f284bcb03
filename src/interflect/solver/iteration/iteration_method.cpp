#include "interflect/solver/iteration/iteration_method.h"

#include "interflect/solver/error/finish_solution.h"

namespace interflect::detail {

IterationPlan IterationMethod::plan(SolverState& state) {
    IterationPlan plan = state.schedule.next(state.seconds());
    plan.old_elements = state.forest->size();
    if (plan.rays > 0) refine_view_importance(state);
    return plan;
}

void IterationMethod::finish(SolverState& state) const { finish_solution(state); }

void IterationMethod::change_views(SolverState& state) {
    compute_view_importance(state);
    state.rays_of_other_views = state.schedule.averaged_rays();
    state.schedule.restart();
}

}  // namespace interflect::detail
