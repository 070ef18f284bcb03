#include "interflect/solve.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/solver.h"
#include "interflect/solver/iteration/report.h"
#include "interflect/solver/run.h"
#include "interflect/solver/state/iteration_start.h"

namespace interflect {

namespace detail {

namespace {

constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();

void limit_time(SolverState& state) {
    state.stop.limit_time(state.start, state.options.limits.time - state.earlier_seconds);
}

/// Runs work that an interruption discards. @throws Interrupted
template <class Work>
void atomically(Run& run, const Work& work) {
    const IterationStart start(run.state);
    try {
        work();
    } catch (const Interrupted&) {
        if (run.state.options.method.is_stochastic) {  // deterministic methods keep finished links
            start.restore(run.state);
            run.method->discard();
        }
        throw;
    }
}

/// Estimates importance (Eq. 7, 8) and makes the initial mesh (Eq. 14, 15). @throws Interrupted
void prepare(Run& run) {
    SolverState& state = run.state;
    if (!state.options.method.is_stochastic) limit_time(state);  // stochastic methods always complete it
    if (!run.is_prepared) atomically(run, [&] { run.method->prepare(state); });
    run.is_prepared = true;
    limit_time(state);
}

/// @param rays_asked_for  In total; extends a completed plan. @return  0 rays if the run is over.
IterationPlan plan_iteration(Run& run, std::int64_t rays_asked_for) {
    SolverState& state = run.state;
    IterationPlan next = run.method->plan(state);
    const bool is_more_asked_for =
        rays_asked_for < unlimited && rays_asked_for > std::max(state.schedule.rays(), state.options.limits.rays);
    if (next.rays > 0 || !is_more_asked_for) return next;
    state.solution.options.limits.rays = rays_asked_for;
    state.schedule.set_limits(state.options.limits);
    return run.method->plan(state);
}

}  // namespace

void iterate_until(Run& run, const Limits& limits) {
    SolverState& state = run.state;
    IterationMethod& method = *run.method;
    const std::int64_t before = state.schedule.rays();
    const std::int64_t rays_asked_for = limits.rays < unlimited - before ? before + limits.rays : unlimited;
    bool has_advanced = !run.is_prepared;
    prepare(run);
    run.is_finished = false;
    while (!(run.error <= std::max(limits.until, state.options.limits.until)) &&
           state.schedule.rays() < rays_asked_for) {
        if (has_advanced && state.seconds_of_this_call() >= limits.time) return;
        IterationPlan plan = plan_iteration(run, rays_asked_for);
        run.is_finished = plan.rays == 0;
        if (run.is_finished) return;
        if (state.stop.is_due()) throw Interrupted();
        atomically(run, [&] {
            method.update_importance(state, plan);                // Eq. 7, 8
            const Estimate estimate = method.trace(state, plan);  // Eq. 1; rays by Eq. 3, 9 to 11, mesh by Eq. 14, 15
            method.merge(state, estimate, plan);                  // Eq. 6
            method.refine(state);                                 // by variance
        });
        state.schedule.done(plan);
        report(state, ++run.iteration);
        run.error = state.solution.iterations.back().error_estimate;
        has_advanced = true;
    }
    run.is_finished = run.error <= state.options.limits.until || method.is_fulfilled(state);
}

}  // namespace detail

Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options, const Monitor& monitor) {
    // Non-owning: both outlive the solver.
    const std::shared_ptr<const Scene> shared_scene(std::shared_ptr<void>(), &scene);
    const std::shared_ptr<const RayCaster> shared_caster(std::shared_ptr<void>(), &ray_caster);
    Solver solver(shared_scene, options, shared_caster);
    solver.advance({}, monitor);
    return std::move(solver).take_solution();
}

}  // namespace interflect
