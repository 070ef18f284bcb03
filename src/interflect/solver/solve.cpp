#include "interflect/solve.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/solver.h"
#include "interflect/solver/iteration/iteration_start.h"
#include "interflect/solver/iteration/report.h"
#include "interflect/solver/run.h"

namespace interflect {

namespace detail {

namespace {

constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();

void start_time_limit(Work& work, const Limits& limits) {
    work.stop.limit_time(work.start_of_this_call, limits.time - work.earlier_seconds);
}

/// Runs a step. If it is interrupted, restores the state; deterministic methods keep finished links.
/// @throws Interrupted
template <class Step>
void run_or_restore(Run& run, const Step& step) {
    IterationStart start(run.state);
    try {
        step();
    } catch (const Interrupted&) {
        if (run.state.light.options().method.is_stochastic) {
            start.restore();
            run.method->discard();
        }
        throw;
    }
}

/// Estimates importance (Eq. 7, 8) and makes the initial mesh (Eq. 14, 15). @throws Interrupted
void prepare(Run& run) {
    SolverState& state = run.state;
    // The time limit does not interrupt the preparation of stochastic methods.
    if (!state.light.options().method.is_stochastic) start_time_limit(state.work, state.light.options().limits);
    if (!run.is_prepared) run_or_restore(run, [&] { run.method->prepare(state); });
    run.is_prepared = true;
    start_time_limit(state.work, state.light.options().limits);
}

/// Plans the next iteration; it has 0 rays if the run is over. Extends a completed run if more rays are requested.
/// @param requested_rays  Total number of rays since the run began.
IterationPlan plan_iteration(Run& run, std::int64_t requested_rays) {
    SolverState& state = run.state;
    IterationPlan next = run.method->plan(state);
    if (next.rays > 0 || requested_rays == unlimited) return next;
    Limits& run_limits = state.light.solution.options.limits;
    if (requested_rays <= std::max(state.rays.schedule.rays(), run_limits.rays)) return next;
    run_limits.rays = requested_rays;
    state.rays.schedule.set_limits(run_limits);
    return run.method->plan(state);
}

}  // namespace

void iterate_until(Run& run, const Limits& call_limits) {
    SolverState& state = run.state;
    IterationMethod& method = *run.method;
    const std::int64_t before = state.rays.schedule.rays();
    const std::int64_t requested_rays = call_limits.rays < unlimited - before ? before + call_limits.rays : unlimited;
    const double target_error = std::max(call_limits.until, state.light.options().limits.until);
    bool has_advanced = !run.is_prepared;  // preparation counts as progress
    prepare(run);
    run.is_finished = false;
    while (!(run.error <= target_error) && state.rays.schedule.rays() < requested_rays) {
        if (has_advanced && state.work.seconds_of_this_call() >= call_limits.time) return;
        const IterationPlan plan = plan_iteration(run, requested_rays);
        run.is_finished = plan.rays == 0;
        if (run.is_finished) return;
        if (state.work.stop.is_due()) throw Interrupted();
        TracedIteration iteration{plan};
        run_or_restore(run, [&] {
            method.update_importance(state, iteration);                // Eq. 7, 8
            const Estimate estimate = method.trace(state, iteration);  // Eq. 1; rays by Eq. 3, 9-11, mesh by Eq. 14, 15
            method.merge(state, estimate, iteration);                  // Eq. 6
            method.refine(state);                                      // mesh by variance
        });
        state.rays.schedule.done(iteration);
        append_report(state, ++run.iteration);
        run.error = state.light.solution.iterations.back().error_estimate;
        has_advanced = true;
    }
    run.is_finished = run.error <= state.light.options().limits.until || method.is_fulfilled(state);
}

}  // namespace detail

Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options, const Monitor& monitor) {
    // The pointers do not own the objects, which outlive the solver.
    const std::shared_ptr<const Scene> shared_scene(std::shared_ptr<void>(), &scene);
    const std::shared_ptr<const RayCaster> shared_caster(std::shared_ptr<void>(), &ray_caster);
    Solver solver(shared_scene, options, shared_caster);
    solver.advance({}, monitor);
    return std::move(solver).take_solution();
}

}  // namespace interflect
