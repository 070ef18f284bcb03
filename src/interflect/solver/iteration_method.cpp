#include "interflect/solver/iteration_method.h"

#include "interflect/solver/detail.h"

namespace interflect::inline detail {

IterationPlan IterationMethod::plan(SolverState& state) {
    const IterationPlan plan = state.schedule.next(state.seconds());
    if (plan.rays > 0) refine_view_importance(state);
    return plan;
}

void IterationMethod::finish(SolverState& state) const { finish_solution(state); }

void IterationMethod::retarget(SolverState& state) {
    look(state);
    state.rays_of_other_views = state.schedule.averaged_rays();
    state.schedule.restart();
}

}  // namespace interflect::inline detail
