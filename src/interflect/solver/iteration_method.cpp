#include "interflect/solver/iteration_method.h"

#include "interflect/solver/detail.h"
#include "interflect/solver/methods/link_radiosity.h"
#include "interflect/solver/methods/one_bounce.h"
#include "interflect/solver/methods/passes.h"
#include "interflect/solver/methods/random_walk.h"
#include "interflect/solver/methods/well_distributed.h"

namespace interflect {

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

std::unique_ptr<IterationMethod> make_iteration_method(SolverState& state) {
    switch (state.options.method.scheme) {
        case Scheme::well_distributed:
            return std::make_unique<WellDistributedRays>(state);
        case Scheme::random_walk:
            return std::make_unique<RandomWalks>(state);
        case Scheme::links:
            return std::make_unique<LinkedElements>(state);
        case Scheme::averaged:
            break;
    }
    if (state.options.complete_passes) return std::make_unique<Passes>();
    return std::make_unique<OneBounce>();
}

}  // namespace interflect
