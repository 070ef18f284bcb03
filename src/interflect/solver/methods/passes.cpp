#include "interflect/solver/methods/passes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/merge.h"
#include "interflect/solver/iteration/outdoor_targets.h"
#include "interflect/solver/iteration/report.h"
#include "interflect/solver/methods/bounce_budget.h"
#include "interflect/solver/methods/importance_transport.h"
#include "interflect/solver/methods/one_bounce.h"
#include "interflect/solver/refinement/oracle_threshold.h"
#include "interflect/solver/refinement/variance_refinement.h"

namespace interflect::detail {

namespace {

/// Minimum for a preparation: a ray for importance, one for each of the two passes of prepare(), one for an iteration.
constexpr std::int64_t fewest_rays_with_preparation = 4;

/// Returns beta p + (1 - beta) w, where p is the unshot power and w the importance-weighted unshot power, both relative
/// to the first bounce, and beta is the share of rays that ignore importance. Returns p if no power is weighted by
/// importance.
double relative_unshot(const PowerPlan& bounce, double first_power, double first_weighted_power, double beta) {
    const auto relative = [](double a, double b) { return b > 0 ? a / b : 0; };
    const double power = relative(bounce.power, first_power);
    if (!(first_weighted_power > 0)) return power;
    return beta * power + (1 - beta) * relative(bounce.weighted_power, first_weighted_power);
}

Estimate zero_estimate(const RunInputs& inputs, const LightState& light) {
    const std::size_t elements = light.forest->size();
    Estimate zero{.irradiance = std::vector<Rgb>(elements, Rgb(0)), .variance = std::vector<float>(elements, 0.0f)};
    zero.groups.assign(inputs.groups.size(), zero.irradiance);
    // Without light groups, direct light is a single part.
    const std::size_t direct_parts = std::max<std::size_t>(1, inputs.groups.size());
    if (light.options().keep_direct) zero.direct.assign(direct_parts, zero.irradiance);
    return zero;
}

/// Adds the received light to the sum. The first call moves the variance; the irradiance is also the next unshot light.
void add(Estimate& sum, Received& received) {
    sum.escaped_power += received.escaped_power;
    accumulate(sum.groups, received.groups);
    if (sum.irradiance.empty()) {
        sum.irradiance = received.irradiance;
        sum.variance = std::move(received.variance);
        return;
    }
    parallel_for_ranges(sum.irradiance.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            sum.irradiance[e] += received.irradiance[e];
            sum.variance[e] += received.variance[e];
        }
    });
}

/// Replaces the light of the solution. The variance is left out, because only iterations estimate noise.
void set_estimate(LightState& light, Estimate estimate) {
    light.solution.irradiance = std::move(estimate.irradiance);
    light.solution.groups = std::move(estimate.groups);
    light.solution.direct = std::move(estimate.direct);
    light.escaped_power = estimate.escaped_power;
}

std::int64_t rays_so_far(const RayTotals& rays) { return rays.power + rays.importance; }

/// Returns whether the oracle refines in iterations. It always refines in prepare(), where the variance is unknown.
bool oracle_refines_passes(const LightState& light) {
    return light.options().method.refines && !refines_by_variance(light.options());
}

}  // namespace

void Passes::prepare(SolverState& state) {
    // Start from zero: an interrupted preparation may have left an estimate.
    set_estimate(state.light, zero_estimate(state.inputs, state.light));
    if (state.light.options().limits.rays < fewest_rays_with_preparation) return;
    const bool uses_importance = importance_use(state.light.solution) == ImportanceUse::full;
    // Importance and two passes share an eighth of all rays. Without importance, each pass gets an eighth, because runs
    // of 20,000 rays need this number for the initial mesh.
    std::int64_t shares = 1;
    if (uses_importance && state.light.options().method.refines) shares = 3;
    const std::int64_t rays = state.rays.schedule.start_rays(shares);
    total_unshot_ = 0;
    if (uses_importance) transport_importance(state, rays);
    aim_outdoor_light(state);  // from skies and suns to important surfaces
    // Trace one pass on the initial mesh, for the light that the oracle needs, then one pass that refines.
    if (state.light.options().method.refines)
        for (const bool oracle_refines : {false, true})
            set_estimate(state.light, trace_pass(state, rays, oracle_refines));
    aim_outdoor_light(state);  // the passes have improved the importance
    state.rays.schedule.record_start(/*averaged_rays=*/0, rays_so_far(state.rays));
    if (rays_so_far(state.rays) > 0) append_report(state, 0);
}

void Passes::update_importance(SolverState& state, TracedIteration& iteration) {
    if (importance_use(state.light.solution) != ImportanceUse::full) return;
    if (needs_importance_) {
        const std::int64_t rays_before = rays_so_far(state.rays);
        transport_importance(state, state.rays.schedule.start_rays());
        const std::vector<OutdoorLine> outdoor_light = aim_outdoor_light(state);
        if (!view_change_.empty()) iteration.history_factor = view_change_.history_factor(state, outdoor_light);
        iteration.rays_for_new_views = rays_so_far(state.rays) - rays_before;
    }
    // By default, the first bounce transports importance. Else trace a step here with the share alpha of the rays, and
    // leave the other rays to trace().
    if (!state.light.options().experimental.separate_iterations) return;
    iteration.importance_rays =
        std::llround(state.light.options().experimental.alpha * static_cast<double>(iteration.plan.rays));
    if (iteration.importance_rays == 0) return;
    const Importance importance = importance_of(state.light.solution);
    const Received received =
        run_step(state, TransportStep(plan_importance(state.inputs.materials, state.light.solution, importance,
                                                      iteration.importance_rays)));
    merge_importance(state.light, state.rays, received.importance, iteration);
    state.rays.importance += iteration.importance_rays;
}

Estimate Passes::trace(SolverState& state, TracedIteration& iteration) {
    if (iteration.plan.rays <= iteration.importance_rays) return {};
    const std::int64_t rays_before = rays_so_far(state.rays);
    Estimate estimate =
        trace_pass(state, iteration.plan.rays - iteration.importance_rays, oracle_refines_passes(state.light));
    // The weight must be positive, but without light no rays are traced
    iteration.rays = std::max<std::int64_t>(1, iteration.importance_rays + rays_so_far(state.rays) - rays_before);
    iteration.weight = iteration.rays;
    return estimate;
}

void Passes::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    state.rays.schedule.count_other_rays(iteration.rays_for_new_views);
    scale_history(state.light, iteration.history_factor);
    needs_importance_ = false;  // cleared here and not before, because an interrupted iteration is repeated
    view_change_.clear();
    if (estimate.irradiance.empty()) return;
    estimate_noise(state, estimate, iteration.weight);
    merge_independent(state.light, state.light.solution.irradiance, estimate.irradiance, iteration);
    merge_independent(state.light, state.light.solution.groups, estimate.groups, iteration);
    merge_independent(state.light, state.light.solution.direct, estimate.direct, iteration);
    merge_escaped_power(state.light, estimate.escaped_power, iteration);
    update_history(state.light, iteration);
}

void Passes::refine(SolverState& state) {
    if (refines_by_variance(state.light.options()) && state.light.noise.is_known()) refine_by_variance(state);
}

struct Passes::Pass {
    const std::int64_t rays;
    const bool oracle_refines;
    BounceBudget budget;
    ImportanceWeights weights;
    /// Per element: 1 if its reflected rays start at hit points (StartPoints), else 0. Empty while the oracle refines.
    std::vector<std::uint8_t> reflecting_where_received = {};
    bool emits = true;             ///< Whether the next bounce shoots emitted power.
    std::vector<Rgb> unshot = {};  ///< Irradiance that the next bounce reflects.
    GroupLight unshot_groups = {};
    StartPoints start_points = {};
    double first_power = 0, first_weighted_power = 0;
    Estimate sum = {};
};

/// @throws Interrupted
Estimate Passes::trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines) {
    state.sampling.payloads = {};  // the report contains the payloads of the last pass only
    Pass pass{rays, oracle_refines, BounceBudget(rays, total_unshot_),
              importance_weights(state.light.solution, state.sampling.neighbourhoods, state.inputs.emission,
                                 state.sampling.part_importance)};
    pass.unshot.assign(state.light.forest->size(), Rgb(0));
    pass.unshot_groups.assign(state.inputs.groups.size(), pass.unshot);
    if (!oracle_refines) pass.reflecting_where_received = leaves_reflecting_where_received(state);
    // trace_bounce() plans the last bounce when few rays or little unshot power are left
    bool has_traced = true;
    while (has_traced && !pass.budget.has_planned_last_bounce()) has_traced = trace_bounce(state, pass);
    total_unshot_ = pass.budget.total_unshot();
    Estimate& sum = pass.sum;
    if (sum.irradiance.empty()) sum = zero_estimate(state.inputs, state.light);  // no bounce had power to shoot
    if (!oracle_refines) {
        // Rays deposit on leaves only, so compute the inner elements from their children.
        pull(*state.light.forest, sum.irradiance);
        pull_variance(*state.light.forest, sum.variance);
        pull(*state.light.forest, sum.groups);
        pull(*state.light.forest, sum.direct);
    }
    return std::move(sum);
}

/// @return  False if no unshot light or rays are left.
bool Passes::trace_bounce(SolverState& state, Pass& pass) {
    Solution& solution = state.light.solution;
    // Only the first bounce transports importance, because it has the most rays.
    const bool carries_importance = pass.emits && importance_use(solution) == ImportanceUse::full &&
                                    !state.light.options().experimental.separate_iterations;
    const Radiosity radiosity(state.inputs.materials, pass.unshot, pass.emits);
    PowerPlan bounce = plan_power(state.inputs.materials, state.inputs.emission, solution, radiosity, pass.weights,
                                  carries_importance, /*rays=*/0);
    solution.non_finite += bounce.non_finite_leaves;
    if (pass.emits) {
        pass.first_power = bounce.power;
        pass.first_weighted_power = bounce.weighted_power;
    }
    const double unshot =
        relative_unshot(bounce, pass.first_power, pass.first_weighted_power, state.light.options().experimental.beta);
    const BounceRays rays = bounce.power > 0 ? pass.budget.next(unshot) : BounceRays();
    if (rays.expected == 0) return false;

    // The last bounce starts fewer rays, which continue as random walks to the end
    bounce.plan.rays = rays.started;
    TransportStep step = make_step(state, pass, std::move(bounce.plan));
    const std::uint32_t old_elements = state.light.forest->size();
    Received received =
        step.completes_by_walks ? run_step(state, std::move(step)) : trace_without_walks(state, std::move(step));

    // Eq. 11: the share alpha of the rays is sampled by importance.
    const double importance_share = carries_importance ? state.light.options().experimental.alpha : 0;
    const std::int64_t importance_rays = std::llround(importance_share * static_cast<double>(rays.expected));
    state.rays.importance += importance_rays;
    state.rays.power += rays.expected - importance_rays;
    state.sampling.payloads += received.payloads;
    grow_pass(*state.light.forest, old_elements, pass);
    if (pass.emits && state.light.options().keep_direct)
        pass.sum.direct = received.groups.empty() ? GroupLight{received.irradiance} : received.groups;
    add(pass.sum, received);
    if (carries_importance)  // merge now, because the oracle uses importance in the next bounces
        merge_importance(state.light, state.rays, received.importance,
                         TracedIteration{.plan = {.rays = rays.expected}});
    pass.emits = false;
    pass.start_points = std::move(received.start_points);
    pass.unshot = std::move(received.irradiance);
    pass.unshot_groups = std::move(received.groups);
    return true;
}

TransportStep Passes::make_step(const SolverState& state, Pass& pass, RayPlan plan) {
    TransportStep step(std::move(plan));
    step.groups = group_radiosity(state.inputs, state.light, pass.unshot_groups, pass.emits);
    step.start_points = &pass.start_points;
    step.oracle_light = Radiosity(state.inputs.materials, state.light.solution.irradiance);
    step.completes_by_walks = pass.budget.has_planned_last_bounce();
    step.reflecting_where_received = pass.reflecting_where_received;
    step.leaves_only = !pass.oracle_refines;
    if (pass.oracle_refines)
        step.oracle = make_oracle(state.light.solution, state.rays.schedule.averaged_rays() + pass.rays,
                                  state.inputs.floor.default_min_area());
    step.reusable_buffer = &pass.unshot;  // the step no longer needs it after tracing
    return step;
}

void Passes::grow_pass(const ElementForest& forest, std::uint32_t old_elements, Pass& pass) {
    if (!pass.sum.irradiance.empty()) {
        inherit(forest, old_elements, pass.sum.irradiance);
        inherit(forest, old_elements, pass.sum.variance);
        inherit(forest, old_elements, pass.sum.groups);
        inherit(forest, old_elements, pass.sum.direct);
    }
    if (!pass.weights.elements.empty()) inherit(forest, old_elements, pass.weights.elements);
}

void Passes::make_first_estimate(SolverState& state) {
    prepare(state);
    set_estimate(state.light, trace_pass(state, state.rays.schedule.start_rays(), false));
    state.light.solution.direct.clear();  // the method that continues does not separate direct light
    // Replaces the record of prepare(), whose rays are included
    state.rays.schedule.record_start(/*averaged_rays=*/0, rays_so_far(state.rays));
    append_report(state, 0);
}

void Passes::change_views(SolverState& state) {
    const bool adapts_history =
        state.rays.schedule.averaged_rays() > 0 && importance_use(state.light.solution) == ImportanceUse::full;
    if (adapts_history && view_change_.empty()) view_change_.record(state);
    IterationMethod::change_views(state);
    // Before the first iteration, prepare() transports importance.
    const bool has_begun = !state.light.solution.iterations.empty();
    needs_importance_ = has_begun && importance_use(state.light.solution) == ImportanceUse::full;
    if (!needs_importance_) view_change_.clear();
}

void Passes::archive(StateArchive& archive) {
    archive.amounts("passes/bounces", total_unshot_);
    archive("passes/finds_importance", needs_importance_);
    view_change_.archive(archive);
}

bool Passes::is_consistent(const SolverState& state) const { return view_change_.is_consistent(state); }

std::unique_ptr<IterationMethod> make_ray_radiosity(SolverState& state) {
    if (state.light.options().experimental.one_bounce) return std::make_unique<OneBounce>();
    return std::make_unique<Passes>();
}

}  // namespace interflect::detail
