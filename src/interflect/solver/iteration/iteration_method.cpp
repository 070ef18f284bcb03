#include "interflect/solver/iteration/iteration_method.h"

#include "interflect/solver/error/finish_solution.h"

namespace interflect::detail {

IterationPlan IterationMethod::plan(SolverState& state) {
    IterationPlan plan = state.rays.schedule.next(state.work.seconds());
    plan.old_elements = state.light.forest->size();
    if (plan.rays > 0) refine_view_importance(state);
    return plan;
}

void IterationMethod::finish(SolverState& state) const { finish_solution(state); }

void IterationMethod::change_views(SolverState& state) {
    compute_view_importance(state);
    state.rays.of_other_views = state.rays.schedule.averaged_rays();
    state.rays.schedule.restart();
}

}  // namespace interflect::detail
