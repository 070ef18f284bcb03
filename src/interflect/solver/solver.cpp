#include "interflect/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/camera.h"
#include "interflect/solver/error/error_estimate.h"
#include "interflect/solver/require_solvable.h"
#include "interflect/solver/run.h"

namespace interflect {

using namespace detail;

namespace {

SolveOptions with_method(SolveOptions options) {
    if (std::string_view(options.method.name) == automatic_method.name)
        options.method = default_method(!options.views.empty());
    return options;
}

}  // namespace

Solver::Solver(Scene scene, const SolveOptions& options)
    : Solver(std::make_shared<const Scene>(std::move(scene)), options) {}

Solver::Solver(std::shared_ptr<const Scene> scene, const SolveOptions& options,
               std::shared_ptr<const RayCaster> ray_caster) {
    const SolveOptions resolved = with_method(options);
    require_solvable(*scene, resolved);
    if (!ray_caster) ray_caster = std::make_shared<RayCaster>(*scene);
    ray_caster->require_made_for(*scene);
    run_ = std::make_unique<Run>(std::move(scene), std::move(ray_caster), resolved);
}

Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

AdvanceReport Solver::advance(const Limits& limits, const Monitor& monitor) {
    Run& run = *run_;
    SolverState& state = run.state;
    run.finished.reset();
    state.work.begin(monitor);
    state.light.solution.interrupted = false;
    const bool is_lit = channel_sum(state.light.solution.emitted_power) > 0;  // without light, the exact solution is 0
    try {
        if (is_lit) iterate_until(run, limits);
    } catch (const Interrupted&) {
        state.light.solution.interrupted = state.work.stop.is_asked_for();
    }
    const bool is_out_of_time = state.work.seconds() >= state.light.options().limits.time;
    state.work.end();
    return {.error = is_lit ? run.error : 0,
            .rays = state.rays.schedule.rays(),
            .seconds = state.work.earlier_seconds,
            .is_finished = !is_lit || run.is_finished || is_out_of_time,
            .is_stopped = state.light.solution.interrupted};
}

void Solver::set_views(std::vector<WeightedView> views) {
    Run& run = *run_;
    SolveOptions options = run.state.light.options();
    options.views = std::move(views);
    require_solvable(*run.scene, options);
    for (const WeightedView& v : options.views) Camera(v.view, 1, 1, run.ray_caster->origin());  // throws InputError
    run.finished.reset();
    run.is_finished = false;
    run.state.light.solution.options.views = std::move(options.views);
    run.method->change_views(run.state);
    run.error = estimate_error(run.state).total();
}

void Solver::set_dimming(const std::string& group, float factor) {
    Run& run = *run_;
    const std::size_t g = run.state.inputs.groups.index_of(group);
    if (!(factor >= 0 && std::isfinite(factor)))
        throw InputError(fmt::format("light group '{}': expected a factor of 0 or more, not {}", group, factor));
    if (!run.state.light.options().method.follows_dimming)
        throw InputError(fmt::format("{} cannot go on with other light: choose a method that averages iterations",
                                     run.state.light.options().method.name));
    run.finished.reset();
    run.is_finished = false;
    run.dim(g, factor);
    run.error = estimate_error(run.state).total();
}

void Solver::set_plan(const Limits& limits) {
    Run& run = *run_;
    SolveOptions options = run.state.light.options();
    options.limits = limits;
    require_solvable(*run.scene, options);
    run.state.light.solution.options = std::move(options);
    run.state.rays.schedule.set_limits(limits);
    run.is_finished = false;
}

const Solution& Solver::solution() const { return *shared_solution(); }

std::shared_ptr<const Solution> Solver::shared_solution() const {
    const std::scoped_lock lock(run_->finishing);
    if (!run_->finished) run_->finished = std::make_shared<const Solution>(run_->snapshot());
    return run_->finished;
}

Solution Solver::take_solution() && {
    Solution& solution = run_->state.light.solution;
    run_->method->finish(run_->state);
    std::fill(solution.dimming.begin(), solution.dimming.end(), 1.0f);
    return std::move(solution);
}

std::shared_ptr<const Scene> Solver::shared_scene() const { return run_->scene; }
std::shared_ptr<const RayCaster> Solver::shared_ray_caster() const { return run_->ray_caster; }
const SolveOptions& Solver::options() const { return run_->state.light.options(); }

}  // namespace interflect
