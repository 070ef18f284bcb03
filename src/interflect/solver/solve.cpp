#include "interflect/solver/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/light.h"
#include "interflect/solver/link_radiosity.h"
#include "interflect/solver/merge.h"
#include "interflect/solver/passes.h"
#include "interflect/solver/random_walk.h"
#include "interflect/solver/run.h"
#include "interflect/solver/steps.h"
#include "interflect/solver/well_distributed.h"

namespace interflect {

namespace {

void require_valid(const Scene& scene, const SolveOptions& o) {
    std::vector<std::string> faults = scene_faults(scene);
    const auto require = [&](bool holds, const std::string& message) {
        if (!holds) faults.push_back(message);
    };
    require(!scene.patches.empty(), "the scene has no patches");
    require(o.rays > 0, "rays: expected more than 0");
    require(o.seconds > 0, "seconds: expected more than 0");
    require(o.until >= 0 && o.until < 1, "until: expected a relative error from 0 to below 1");
    require(o.warm_up >= 0, "warm_up: expected 0 or more");
    require(o.iterations >= 0, "iterations: expected 0 or more");
    require(o.rays_per_iteration >= 0 && o.rays_per_iteration <= most_rays_per_iteration,
            "rays_per_iteration: expected 0 to 100 thousand million");
    require(o.epsilon > 0, "epsilon: expected more than 0");
    require(o.epsilon_decay >= 0 && o.epsilon_decay <= 1, "epsilon_decay: expected 0 to 1");
    require(o.smallest_area >= 0, "smallest_area: expected 0 or more");
    require(o.most_elements >= scene.patches.size() && o.most_elements < 0xfffffff0u,
            fmt::format("most_elements: {}, expected at least the number of patches, {}, and less than 2^32 - 16",
                        o.most_elements, scene.patches.size()));
    require(o.alpha >= 0 && o.alpha <= 1, "alpha: expected 0 to 1");
    require(o.beta >= 0 && o.beta <= 1, "beta: expected 0 to 1");
    require(o.inherited_trust >= 0 && o.inherited_trust <= 1, "inherited_trust: expected 0 to 1");
    require(o.importance_smoothing >= 0 && o.importance_smoothing <= 1, "importance_smoothing: expected 0 to 1");
    require(o.importance_exponent >= 0 && o.importance_exponent <= 1, "importance_exponent: expected 0 to 1");
    require(o.eye_rays > 0 && o.eye_rays <= most_eye_rays, "eye_rays: expected 1 to 2^22");
    for (const WeightedView& v : o.views)
        require(v.weight > 0 && std::isfinite(v.weight) && v.aspect > 0 && std::isfinite(v.aspect) && v.pixel_rows > 0,
                "view '" + v.view.name + "': weight, aspect and pixel_rows: expected finite numbers above 0");
    require(o.method.scheme != Scheme::well_distributed || o.method.importance == ImportanceUse::off,
            "importance: a method that keeps every ray needs rays of equal power, which importance does not give");
    require_no_faults(faults, "cannot solve", scene);
}

/// One iteration: what is received in one bounce of the present estimate, merged with the past.
/// @return The power that left the scene.
RgbD iterate(Run& run, IterationPlan& plan) {
    Solution& solution = run.solution;
    const std::uint32_t elements_before = run.forest->size();
    const bool with_importance = importance_use(solution) == ImportanceUse::full;
    const bool combined = with_importance && !run.options.separate_iterations;
    const std::int64_t for_importance =
        with_importance ? std::llround(run.options.alpha * static_cast<double>(plan.rays)) : 0;
    run.importance_rays += for_importance;
    run.power_rays += plan.rays - for_importance;
    if (with_importance && !combined && for_importance > 0) {
        const Received received =
            run_step(run, importance_step(run.surfaces, solution, importance_of(solution), for_importance));
        merge(run, solution.indirect_importance, received.importance, plan);
    }
    RgbD escaped_power(0, 0, 0);
    const std::int64_t rays = combined ? plan.rays : plan.rays - for_importance;
    if (rays > 0) {
        const Light light(run.surfaces, solution.irradiance);
        const PowerDriver driver = power_driver(solution, run.neighbourhoods);
        TransportStep step = power_step(run.surfaces, solution, light, driver, combined, rays).step;
        const bool deferred = run.options.defer_refinement && plan.warms_up;
        if (run.options.method.refines && !deferred)
            step.oracle = make_oracle(solution, run.schedule.averaged_rays() + rays, run.floor.unseen());
        Received received = run_step(run, std::move(step));
        const FreshEstimate fresh{std::move(received.irradiance), std::move(received.variance)};
        if (!plan.warms_up) estimate_noise(run, fresh, rays);
        merge(run, solution.irradiance, fresh.irradiance, plan);
        if (combined) merge(run, solution.indirect_importance, received.importance, plan);
        escaped_power = received.escaped_power;
    }
    remember(run, plan, elements_before);
    return escaped_power;
}

bool reached(const Run& run) {
    const std::vector<IterationReport>& reports = run.solution.iterations;
    return !reports.empty() && reports.back().error_estimate <= run.options.until;
}

/// One iteration of so many rays; it may change their number. @return The power that left the scene.
using Iteration = std::function<RgbD(Run&, IterationPlan&)>;

/// Makes what iterations begin with, and how each of them is done.
Iteration begin_iterations(Run& run) {
    const bool by_passes = run.options.complete_passes;
    switch (run.options.method.scheme) {
        case Scheme::well_distributed:
            if (by_passes) make_first_estimate(run);
            return [rays = WellDistributedRays(run)](Run& r, IterationPlan& plan) mutable {
                return rays.iterate(r, plan);
            };
        case Scheme::random_walk:
            return [walks = RandomWalks(run)](Run& r, IterationPlan& plan) mutable { return walks.iterate(r, plan); };
        default:
            if (!by_passes) return iterate;
            return [state = prepare_passes(run)](Run& r, IterationPlan& plan) mutable {
                return iterate_pass(r, state, plan);
            };
    }
}

/// @throws Interrupted in the middle of an iteration.
void iterate_until_done(Run& run) {
    const Iteration iterate_once = begin_iterations(run);
    run.stop.limit_time(run.start, run.options.seconds);
    for (int iteration = 1; !reached(run); ++iteration) {
        IterationPlan plan = run.schedule.next(run.seconds());
        if (plan.rays == 0) return;
        look_closer(run);
        const RgbD escaped_power = iterate_once(run, plan);
        run.schedule.done(plan);
        report(run, iteration, escaped_power);
    }
}

Solution solve_by_iterations(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                             const Monitor& monitor) {
    Run run(scene, ray_caster, options, monitor);
    const bool is_lit = channel_sum(run.solution.emitted_power) > 0;  // else it is dark, and exactly so
    try {
        if (is_lit) iterate_until_done(run);
    } catch (const Interrupted&) {
        run.solution.interrupted = run.stop.is_asked_for();
    }
    finish_solution(run);
    return std::move(run.solution);
}

}  // namespace

const Method& find_method(const std::string& name) {
    std::string known;
    for (const Method& method : methods) {
        if (name == method.name) return method;
        known += (known.empty() ? "" : ", ") + std::string(method.name);
    }
    throw InputError("there is no method '" + name + "'; there are: " + known);
}

Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options, const Monitor& monitor) {
    require_valid(scene, options);
    ray_caster.require_made_for(scene);
    if (options.method.scheme == Scheme::links) return solve_by_links(scene, ray_caster, options, monitor);
    return solve_by_iterations(scene, ray_caster, options, monitor);
}

}  // namespace interflect
