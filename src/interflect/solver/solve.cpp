#include "interflect/solver/solve.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/solver/light.h"
#include "interflect/solver/link_radiosity.h"
#include "interflect/solver/random_walk.h"
#include "interflect/solver/run.h"
#include "interflect/solver/steps.h"
#include "interflect/solver/well_distributed.h"

namespace interflect {

namespace {

void require_valid(const Scene& scene, const SolveOptions& o) {
    std::vector<std::string> faults = scene_faults(scene);
    const auto require = [&](bool holds, const char* message) {
        if (!holds) faults.emplace_back(message);
    };
    require(!scene.patches.empty(), "the scene has no patches");
    require(o.rays > 0, "rays: expected more than 0");
    require(o.seconds > 0, "seconds: expected more than 0");
    require(o.until >= 0 && o.until < 1, "until: expected a relative error from 0 to below 1");
    require(o.warm_up >= 0, "warm_up: expected 0 or more");
    require(o.iterations >= 0, "iterations: expected 0 or more");
    require(o.rays_per_iteration >= 0, "rays_per_iteration: expected 0 or more");
    require(o.epsilon > 0, "epsilon: expected more than 0");
    require(o.epsilon_decay >= 0 && o.epsilon_decay <= 1, "epsilon_decay: expected 0 to 1");
    require(o.smallest_area >= 0, "smallest_area: expected 0 or more");
    require(o.most_elements >= scene.patches.size() && o.most_elements < 0xfffffff0u,
            "most_elements: expected at least the number of patches and less than 2^32 - 16");
    require(o.alpha >= 0 && o.alpha <= 1, "alpha: expected 0 to 1");
    require(o.beta >= 0 && o.beta <= 1, "beta: expected 0 to 1");
    require(o.inherited_trust >= 0 && o.inherited_trust <= 1, "inherited_trust: expected 0 to 1");
    require(o.importance_smoothing >= 0 && o.importance_smoothing <= 1, "importance_smoothing: expected 0 to 1");
    require(o.importance_exponent >= 0 && o.importance_exponent <= 1, "importance_exponent: expected 0 to 1");
    require(o.eye_rays > 0, "eye_rays: expected more than 0");
    require(o.method.scheme != Scheme::well_distributed || o.method.importance == ImportanceUse::off,
            "importance: a method that keeps every ray needs rays of equal power, which importance does not give");
    if (faults.empty()) return;
    std::string message = "cannot solve '" + scene.name + "':";
    for (const std::string& f : faults) message += "\n  " + f;
    throw InputError(message);
}

/// What scales children to their parent's mean: factor child + offset. Where all of them are 0 there is nothing to
/// scale, and they get the mean.
template <class T>
struct Scaling {
    T factor, offset;
};
Scaling<float> scaling(float children_mean, float parent_mean) {
    const bool is_scaled = children_mean > 0;
    return {is_scaled ? parent_mean / children_mean : 0, is_scaled ? 0 : parent_mean};
}
Scaling<Rgb> scaling(const Rgb& children_mean, const Rgb& parent_mean) {
    const auto [fx, ox] = scaling(children_mean.x, parent_mean.x);
    const auto [fy, oy] = scaling(children_mean.y, parent_mean.y);
    const auto [fz, oz] = scaling(children_mean.z, parent_mean.z);
    return {Rgb(fx, fy, fz), Rgb(ox, oy, oz)};
}

/// Eq. 6 with a tau for each element: what N rays brought, among the rays that its mean stands for so far. A patch has
/// the same tau as all others. Children made later have a larger one, but only for how they share what their parent
/// has: so none of the light is forgotten, and none counts twice. Where no element is younger than others this is
/// Eq. 6 as it is.
template <class T>
void merge(const Run& run, std::vector<T>& mean, const std::vector<T>& received, const IterationPlan& plan) {
    const ElementForest& forest = *run.forest;
    const auto rays = static_cast<float>(plan.rays);
    const auto merge_one = [&](std::uint32_t e) {
        const float tau = plan.warms_up ? 1.0f : rays / (run.history[e] + rays);
        mean[e] += tau * (received[e] - mean[e]);
    };
    parallel_for_ranges(forest.patch_count(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) merge_one(e);
    });
    forest.for_siblings_from_roots([&](std::uint32_t first) {
        T sum(0);
        float area = 0;
        for (std::uint32_t e = first; e < first + 4; ++e) {
            merge_one(e);
            sum += mean[e] * forest.area(e);
            area += forest.area(e);
        }
        const auto [factor, offset] = scaling(sum / area, mean[forest.parent(first)]);
        for (std::uint32_t e = first; e < first + 4; ++e) mean[e] = mean[e] * factor + offset;
    });
    pull(forest, mean);
}

/// From now on the means stand for this iteration's rays too; for elements made in it, `first_new` and on, which
/// inherited a mean that is too smooth, less of them count.
void remember(Run& run, const IterationPlan& plan, std::uint32_t first_new) {
    const auto rays = static_cast<float>(plan.rays), trust = static_cast<float>(run.options.inherited_trust);
    parallel_for_ranges(run.history.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e)
            run.history[e] = plan.warms_up ? 0.0f : (run.history[e] + rays) * (e < first_new ? 1.0f : trust);
    });
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
        TransportStep step = power_step(run.surfaces, solution, light, combined, rays);
        const bool deferred = run.options.defer_refinement && plan.warms_up;
        if (run.options.method.refines && !deferred)
            step.oracle = make_oracle(solution, step, run.schedule.averaged_rays() + rays, run.smallest_element);
        const Received received = run_step(run, std::move(step));
        if (run.schedule.averaged_rays() > 0) estimate_error(run, received.irradiance, rays);
        merge(run, solution.irradiance, received.irradiance, plan);
        if (combined) merge(run, solution.indirect_importance, received.importance, plan);
        escaped_power = received.escaped_power;
    }
    remember(run, plan, elements_before);
    return escaped_power;
}

bool reached(const Run& run, double relative_error) {
    return relative_error > 0 && run.error.relative(run.schedule.averaged_rays()) <= relative_error;
}

/// What is known of each element beside its irradiance.
void describe_elements(Run& run) {
    Solution& solution = run.solution;
    solution.standard_error.resize(run.forest->size());
    for (std::uint32_t e = 0; e < run.forest->size(); ++e)
        solution.standard_error[e] = std::sqrt(run.variance[e] / std::max(run.history[e], 1.0f));
    run.streams.used.resize(run.forest->size(), 0);
    solution.rays.assign(run.streams.used.begin(), run.streams.used.end());
}

/// One iteration of so many rays; it may change their number. @return The power that left the scene.
using Iteration = std::function<RgbD(Run&, IterationPlan&)>;

Iteration iteration_of(Run& run) {
    switch (run.options.method.scheme) {
        case Scheme::well_distributed:
            return [rays = WellDistributedRays(run)](Run& r, IterationPlan& plan) mutable {
                return rays.iterate(r, plan);
            };
        case Scheme::random_walk:
            return [walks = RandomWalks(run)](Run& r, IterationPlan& plan) mutable { return walks.iterate(r, plan); };
        default:
            return iterate;
    }
}

Solution iterate_until_done(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                            const Monitor& monitor) {
    Run run(scene, ray_caster, options, monitor);
    if (channel_sum(run.solution.emitted_power) > 0) {  // else it is dark, and exactly so
        if (options.incremental_start && options.method.scheme != Scheme::random_walk) start_incrementally(run);
        const Iteration iterate_once = iteration_of(run);
        for (int iteration = 1; !reached(run, options.until); ++iteration) {
            IterationPlan plan = run.schedule.next(run.seconds());
            if (plan.rays == 0) break;
            run.solution.interrupted = run.stop_is_asked_for();
            if (run.solution.interrupted) break;
            look_closer(run);
            const RgbD escaped_power = iterate_once(run, plan);
            run.schedule.done(plan);
            report(run, iteration, escaped_power);
        }
    }
    describe_elements(run);
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
    if (options.method.scheme == Scheme::links) return solve_by_links(scene, ray_caster, options, monitor);
    return iterate_until_done(scene, ray_caster, options, monitor);
}

}  // namespace interflect
