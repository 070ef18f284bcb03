#include "interflect/solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "interflect/elements/forest.h"
#include "interflect/error.h"
#include "interflect/raycast/camera.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/iteration_method.h"
#include "interflect/solver/require_solvable.h"
#include "interflect/solver/state_archive.h"

namespace interflect {

struct Solver::Run {
    Run(std::shared_ptr<const Scene> s, std::shared_ptr<const RayCaster> caster, const SolveOptions& options)
        : undimmed_scene(std::move(s)),
          ray_caster(std::move(caster)),
          state(*undimmed_scene, *ray_caster, options),
          method(state.options.method.make(state)),
          known_dimming(state.groups.size(), 1) {}

    const std::shared_ptr<const Scene> undimmed_scene;
    std::shared_ptr<const Scene> scene = undimmed_scene;  // with current exitances
    const std::shared_ptr<const RayCaster> ray_caster;
    SolverState state;
    const std::unique_ptr<IterationMethod> method;
    bool is_prepared = false, is_finished = false;
    double error = std::numeric_limits<double>::infinity();  // estimate for the current views
    int iteration = 0;
    std::optional<Solution> finished;  // cached solution()
    std::vector<float> known_dimming;  // factors for which the stored light was computed

    void iterate_until(const Limits& limits);
    template <class Work>
    void atomically(const Work& work);
    IterationPlan next_plan(std::int64_t rays_asked_for);
    void limit_time();
    Solution snapshot();
    void dim(std::size_t group, float factor);
    void dim_sources();
};

void Solver::Run::dim_sources() {
    const bool is_dimmed = std::any_of(state.solution.dimming.begin(), state.solution.dimming.end(),
                                       [](float factor) { return factor != 1; });
    const std::shared_ptr<const Scene> before = scene;  // keep it alive while referenced
    scene = is_dimmed ? std::make_shared<const Scene>(dimmed(*undimmed_scene, state.groups, state.solution.dimming))
                      : undimmed_scene;
    set_sources(state, *scene);
}

void Solver::Run::dim(std::size_t group, float factor) {
    Solution& solution = state.solution;
    const float change = factor > 0 ? factor / known_dimming[group] : 1;  // the light of a dark group is kept
    if (factor > 0) known_dimming[group] = factor;
    solution.dimming[group] = factor;
    for (Rgb& h : solution.groups[group]) h *= change;
    solution.irradiance = sum_of(solution.groups, solution.dimming);
    dim_sources();
    state.escaped_power_rays = 0;  // unknown until the next iteration ends
}

void Solver::Run::limit_time() {
    state.stop.limit_time(state.start, state.options.limits.time - state.earlier_seconds);
}

/// @param rays_asked_for  Total number; extends a completed plan.
IterationPlan Solver::Run::next_plan(std::int64_t rays_asked_for) {
    const IterationPlan next = method->plan(state);
    const bool is_more_asked_for = rays_asked_for < std::numeric_limits<std::int64_t>::max() &&
                                   rays_asked_for > std::max(state.schedule.rays(), state.options.limits.rays);
    if (next.rays > 0 || !is_more_asked_for) return next;
    state.solution.options.limits.rays = rays_asked_for;
    state.schedule.set_limits(state.options.limits);
    return method->plan(state);
}

/// Discards interrupted work. @throws Interrupted
template <class Work>
void Solver::Run::atomically(const Work& work) {
    const IterationStart start(state);
    try {
        work();
    } catch (const Interrupted&) {
        if (state.options.method.is_stochastic) start.restore(state);  // finished links are kept
        throw;
    }
}

/// @throws Interrupted
void Solver::Run::iterate_until(const Limits& limits) {
    const std::int64_t all = std::numeric_limits<std::int64_t>::max(), before = state.schedule.rays();
    const std::int64_t rays_asked_for = limits.rays < all - before ? before + limits.rays : all;
    bool has_advanced = !is_prepared;
    if (!state.options.method.is_stochastic) limit_time();  // others always compute a first estimate
    if (!is_prepared) atomically([&] { method->prepare(state); });
    is_prepared = true;
    limit_time();
    is_finished = false;
    while (!(error <= std::max(limits.until, state.options.limits.until)) && state.schedule.rays() < rays_asked_for) {
        if (has_advanced && state.seconds_of_this_call() >= limits.time) return;
        IterationPlan plan = next_plan(rays_asked_for);
        is_finished = plan.rays == 0;
        if (is_finished) return;
        if (state.stop.is_due()) throw Interrupted();
        RgbD escaped_power;
        atomically([&] { escaped_power = method->iterate(state, plan); });
        state.schedule.done(plan);
        report(state, ++iteration, escaped_power);
        error = state.solution.iterations.back().error_estimate;
        has_advanced = true;
    }
    is_finished = error <= state.options.limits.until || method->is_fulfilled(state);
}

/// Copies the forest, because that of the run grows.
Solution Solver::Run::snapshot() {
    Solution copy = state.solution;
    method->finish(state);  // modifies irradiance
    std::swap(copy, state.solution);
    std::fill(copy.dimming.begin(), copy.dimming.end(), 1.0f);  // relative to the sources of `scene`
    const auto forest = std::make_shared<ElementForest>(*scene, state.forest->size());
    forest->rebuild(state.forest->subdivided());
    copy.forest = forest;
    return copy;
}

namespace {

SolveOptions with_method(SolveOptions options) {
    if (!options.method.make) options.method = default_method(!options.views.empty());
    return options;
}

std::shared_ptr<const RayCaster> caster_of(const Scene& scene, const SolveOptions& options) {
    require_solvable(scene, with_method(options));
    return std::make_shared<RayCaster>(scene);
}

}  // namespace

Solver::Solver(Scene scene, const SolveOptions& options)
    : Solver(std::make_shared<const Scene>(std::move(scene)), options) {}

Solver::Solver(const std::shared_ptr<const Scene>& scene, const SolveOptions& options)
    : Solver(scene, caster_of(*scene, options), options) {}

Solver::Solver(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> ray_caster,
               const SolveOptions& options) {
    const SolveOptions resolved = with_method(options);
    require_solvable(*scene, resolved);
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
    state.begin_work(monitor);
    state.solution.interrupted = false;
    const bool is_lit = channel_sum(state.solution.emitted_power) > 0;  // otherwise 0 is the exact solution
    try {
        if (is_lit) run.iterate_until(limits);
    } catch (const Interrupted&) {
        state.solution.interrupted = state.stop.is_asked_for();
    }
    const bool is_out_of_time = state.seconds() >= state.options.limits.time;
    state.end_work();
    return {.error = is_lit ? run.error : 0,
            .rays = state.schedule.rays(),
            .seconds = state.earlier_seconds,
            .is_finished = !is_lit || run.is_finished || is_out_of_time,
            .is_stopped = state.solution.interrupted};
}

void Solver::set_views(std::vector<WeightedView> views) {
    Run& run = *run_;
    SolveOptions options = run.state.options;
    options.views = std::move(views);
    require_solvable(*run.scene, options);
    for (const WeightedView& v : options.views) Camera(v.view, 1, 1, run.ray_caster->origin());  // throws InputError
    run.finished.reset();
    run.is_finished = false;
    run.state.solution.options.views = std::move(options.views);
    run.method->retarget(run.state);
    run.error = solution_error(run.state).total();
}

void Solver::set_exitance(const std::string& group, float factor) {
    Run& run = *run_;
    const std::size_t g = run.state.groups.index_of(group);
    if (!(factor >= 0 && std::isfinite(factor)))
        throw InputError(fmt::format("light group '{}': expected a factor of 0 or more, not {}", group, factor));
    if (!run.state.options.method.follows_dimming)
        throw InputError(fmt::format("{} cannot go on with other light: choose a method that averages iterations",
                                     run.state.options.method.name));
    run.finished.reset();
    run.is_finished = false;
    run.dim(g, factor);
    run.error = solution_error(run.state).total();
}

void Solver::set_plan(const Limits& limits) {
    Run& run = *run_;
    SolveOptions options = run.state.options;
    options.limits = limits;
    require_solvable(*run.scene, options);
    run.state.solution.options = std::move(options);
    run.state.schedule.set_limits(limits);
    run.is_finished = false;
}

const Solution& Solver::solution() const {
    if (!run_->finished) run_->finished = run_->snapshot();
    return *run_->finished;
}

Solution Solver::take_solution() && {
    Solution& solution = run_->state.solution;
    run_->method->finish(run_->state);
    std::fill(solution.dimming.begin(), solution.dimming.end(), 1.0f);
    return std::move(solution);
}

std::shared_ptr<const Scene> Solver::shared_scene() const { return run_->scene; }
std::shared_ptr<const Scene> Solver::undimmed_scene() const { return run_->undimmed_scene; }
const std::vector<float>& Solver::dimming() const { return run_->state.solution.dimming; }
std::shared_ptr<const RayCaster> Solver::shared_ray_caster() const { return run_->ray_caster; }
const SolveOptions& Solver::options() const { return run_->state.options; }

void Solver::archive(StateArchive& archive) {
    run_->state.archive(archive);
    run_->method->archive(archive);
    if (archive.reads() && !run_->method->fits(run_->state))
        throw std::runtime_error("the state of the run: arrays and elements differ in number");
    archive("is_prepared", run_->is_prepared);
    archive("is_finished", run_->is_finished);
    archive("error", run_->error);
    archive("iteration", run_->iteration);
    archive("known_dimming", run_->known_dimming);
    archive("dimming", run_->state.solution.dimming);
    if (archive.reads() && (run_->known_dimming.size() != run_->state.groups.size() ||
                            run_->state.solution.dimming.size() != run_->state.groups.size()))
        throw std::runtime_error("the state of the run: expected the dimming of every light group");
    if (archive.reads()) run_->dim_sources();
}

}  // namespace interflect
