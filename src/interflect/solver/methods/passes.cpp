#include "interflect/solver/methods/passes.h"

#include <algorithm>
#include <cassert>
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

/// Minimum number of rays of a run that makes an initial mesh: one for importance, one for each of the two passes of
/// make_initial_mesh(), and one for an iteration.
constexpr std::int64_t fewest_rays_with_initial_mesh = 4;

Estimate zero_estimate(const RunInputs& inputs, const LightState& light) {
    const std::vector<Rgb> dark(light.forest->size(), Rgb(0));
    Estimate zero{.irradiance = dark, .variance = std::vector<float>(dark.size(), 0.0f)};
    zero.groups.assign(inputs.groups.size(), dark);
    // Direct light has an array for each light group, or one array without groups.
    const std::size_t direct_arrays = std::max<std::size_t>(1, inputs.groups.size());
    if (light.options().keep_direct) zero.direct.assign(direct_arrays, dark);
    return zero;
}

/// Adds the light of a bounce to the sum. Copies the irradiance of the first bounce, because the next bounce shoots it.
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

/// Replaces the light of the solution. Ignores the variance, because only iterations estimate noise.
void set_estimate(LightState& light, Estimate estimate) {
    light.solution.irradiance = std::move(estimate.irradiance);
    light.solution.groups = std::move(estimate.groups);
    light.solution.direct = std::move(estimate.direct);
    light.escaped_power = estimate.escaped_power;
}

/// Returns the number of rays traced so far, also in the current iteration.
std::int64_t rays_so_far(const RayTotals& rays) { return rays.power + rays.importance; }

/// Adds the rays of a bounce to the totals. Rays that carry power and importance are divided: the share alpha, for
/// which the importance determines the sampling (Eq. 11, Prikryl et al. 2000), counts as importance rays.
void count_rays(RayTotals& totals, std::int64_t rays, bool carries_importance, double alpha) {
    const double importance_share = carries_importance ? alpha : 0;
    const std::int64_t importance_rays = std::llround(importance_share * static_cast<double>(rays));
    totals.importance += importance_rays;
    totals.power += rays - importance_rays;
}

/// Returns whether the oracle refines the mesh during iterations. The initial mesh always needs the oracle, because the
/// variance is unknown there.
bool oracle_refines_in_iterations(const LightState& light) {
    return light.options().method.refines && !refines_by_variance(light.options());
}

/// Traces a step of rays that carry importance alone, with the share alpha of the iteration's rays.
void trace_importance(SolverState& state, TracedIteration& iteration) {
    iteration.importance_rays =
        std::llround(state.light.options().experimental.alpha * static_cast<double>(iteration.plan.rays));
    if (iteration.importance_rays == 0) return;
    const Importance importance = importance_of(state.light.solution);
    RayPlan plan = plan_importance(state.inputs.materials, state.light.solution, importance, iteration.importance_rays);
    const Received received = run_step(state, TransportStep(std::move(plan)));
    merge_importance(state.light, state.rays, received.importance, iteration);
    state.rays.importance += iteration.importance_rays;
}

}  // namespace

/// State of a pass between two bounces.
struct Passes::Pass {
    const std::int64_t rays;    ///< Number of rays of all bounces.
    const bool oracle_refines;  ///< Whether the oracle refines the mesh while rays are traced.
    BounceBudget budget;
    ImportanceWeights weights;
    bool sums_leaves = false;      ///< Whether `sum` has only the irradiance of leaves while rays are traced.
    bool repeats_weights = false;  ///< Whether each bounce computes the weights of elements again, to save memory.
    /// Flag of each element: 1 if its reflected rays start at hit points (StartPoints), else 0. Empty while the oracle
    /// refines.
    std::vector<std::uint8_t> reflecting_where_received = {};

    Estimate sum = {};                  ///< Light of the traced bounces.
    std::uint32_t elements_of_sum = 0;  ///< If not 0: sum.irradiance has only the leaves of this number of elements.
    double first_power = 0, first_weighted_power = 0;  ///< Power of the first bounce, plain and weighted by importance.

    bool emits = true;              ///< Whether the next bounce is the first, which shoots the emitted power.
    std::vector<Rgb> unshot = {};   ///< Irradiance that the next bounce reflects; empty in the first.
    GroupLight unshot_groups = {};  ///< `unshot` of each light group.
    StartPoints start_points = {};  ///< Points that received `unshot`.

    double relative_unshot(const PowerPlan& bounce, double beta) const;
    TransportStep make_step(const SolverState& state, RayPlan plan);
    void grow(const ElementForest& forest, std::uint32_t old_elements);
    void add_bounce(Received received, bool keeps_direct);
    void reduce_sum_to_leaves(const ElementForest& forest);
    void expand_sum(const ElementForest& forest);
};

/// Returns the power that a bounce shoots, relative to the first bounce: beta p + (1 - beta) w. The share beta of the
/// rays ignores importance, so it follows the ratio p of the powers. The others follow the ratio w of the
/// importance-weighted powers. Returns p if the weighted power of the first bounce is 0.
double Passes::Pass::relative_unshot(const PowerPlan& bounce, double beta) const {
    const double power = first_power > 0 ? bounce.power / first_power : 0;
    if (!(first_weighted_power > 0)) return power;
    return beta * power + (1 - beta) * (bounce.weighted_power / first_weighted_power);
}

/// Makes the step of the next bounce.
TransportStep Passes::Pass::make_step(const SolverState& state, RayPlan plan) {
    TransportStep step(std::move(plan));
    step.groups = group_radiosity(state.inputs, state.light, unshot_groups, emits);
    step.start_points = &start_points;
    step.oracle_light = Radiosity(state.inputs.materials, state.light.solution.irradiance);
    step.completes_by_walks = budget.has_planned_last_bounce();  // the planned bounce is that of this step
    step.reflecting_where_received = reflecting_where_received;
    step.leaves_only = !oracle_refines;
    const std::int64_t rays_in_mean = state.rays.schedule.averaged_rays() + rays;
    if (oracle_refines)
        step.oracle = make_oracle(state.light.solution, rays_in_mean, state.inputs.element_floor.default_min_area());
    // The step may reuse the memory of `unshot` after tracing, because add_bounce() replaces it
    step.reusable_buffer = &unshot;
    return step;
}

/// Initialises the new elements of a bounce with the values of their parents.
/// @param old_elements  Number of elements before the bounce.
void Passes::Pass::grow(const ElementForest& forest, std::uint32_t old_elements) {
    if (!sum.irradiance.empty()) {
        inherit(forest, old_elements, sum.irradiance);
        inherit(forest, old_elements, sum.variance);
        inherit(forest, old_elements, sum.groups);
        inherit(forest, old_elements, sum.direct);
    }
    if (!weights.elements.empty()) inherit(forest, old_elements, weights.elements);
}

/// Adds the received light to the sum. The next bounce will shoot it.
void Passes::Pass::add_bounce(Received received, bool keeps_direct) {
    // With keep_direct, the first bounce contains no random walks, and thus no indirect light (BounceBudget)
    if (emits && keeps_direct) sum.direct = received.groups.empty() ? GroupLight{received.irradiance} : received.groups;
    add(sum, received);
    emits = false;
    start_points = std::move(received.start_points);
    unshot = std::move(received.irradiance);
    unshot_groups = std::move(received.groups);
}

/// Removes the irradiance of inner elements from the sum, to save memory while rays are traced. Their variance stays,
/// because children that inherit light from their parent have correlated noise.
void Passes::Pass::reduce_sum_to_leaves(const ElementForest& forest) {
    keep_leaves(forest, sum.irradiance);
    elements_of_sum = forest.size();
}

/// Reverses reduce_sum_to_leaves(). Inner elements are 0 until trace_pass() computes them from their children.
void Passes::Pass::expand_sum(const ElementForest& forest) {
    if (elements_of_sum == 0) return;
    expand_leaves(forest, elements_of_sum, sum.irradiance);
    elements_of_sum = 0;
}

void Passes::prepare(SolverState& state) {
    make_initial_mesh(state);
    if (rays_so_far(state.rays) == 0) return;
    state.rays.schedule.record_start(/*averaged_rays=*/0, rays_so_far(state.rays));
    append_report(state, 0);
}

void Passes::make_initial_mesh(SolverState& state) {
    // Start from zero: an interrupted preparation may have left an estimate.
    set_estimate(state.light, zero_estimate(state.inputs, state.light));
    if (state.light.options().limits.rays < fewest_rays_with_initial_mesh) return;
    total_unshot_ = 0;
    const bool uses_importance = importance_use(state.light.solution) == ImportanceUse::full;
    const bool refines = state.light.options().method.refines;
    // With importance and refinement, the importance and the two passes share an eighth of all rays. Importance alone
    // uses an eighth. Without importance, each pass uses an eighth, because runs of 20,000 rays need the larger number.
    const std::int64_t sharing_steps = uses_importance && refines ? 3 : 1;
    const std::int64_t rays_per_step = state.rays.schedule.start_rays(sharing_steps);
    if (uses_importance) transport_importance(state, rays_per_step);
    // Aim the rays of skies and suns at important surfaces
    aim_outdoor_light(state);
    if (refines) {
        // Estimate the light on the initial mesh, then refine with this light in the oracle
        set_estimate(state.light, trace_pass(state, rays_per_step, /*oracle_refines=*/false));
        set_estimate(state.light, trace_pass(state, rays_per_step, /*oracle_refines=*/true));
    }
    // Aim again with the importance of the passes. Without refinement, new rays only repeat the first sampling
    aim_outdoor_light(state);
}

void Passes::update_importance(SolverState& state, TracedIteration& iteration) {
    if (importance_use(state.light.solution) != ImportanceUse::full) return;
    if (needs_importance_) adapt_to_new_views(state, iteration);
    // By default, the rays of a pass's first bounce carry power and importance.
    if (state.light.options().experimental.separate_iterations) trace_importance(state, iteration);
}

void Passes::adapt_to_new_views(SolverState& state, TracedIteration& iteration) {
    const std::int64_t rays_before = rays_so_far(state.rays);
    transport_importance(state, state.rays.schedule.start_rays());
    const std::vector<OutdoorLine> outdoor_light = aim_outdoor_light(state);
    if (!view_change_.empty()) iteration.history_factor = view_change_.history_factor(state, outdoor_light);
    iteration.rays_for_new_views = rays_so_far(state.rays) - rays_before;
}

Estimate Passes::trace(SolverState& state, TracedIteration& iteration) {
    if (iteration.plan.rays <= iteration.importance_rays) return {};
    const std::int64_t rays_before = rays_so_far(state.rays);
    Estimate estimate =
        trace_pass(state, iteration.plan.rays - iteration.importance_rays, oracle_refines_in_iterations(state.light));
    const std::int64_t traced = iteration.importance_rays + rays_so_far(state.rays) - rays_before;
    // All rays of an iteration count as its weight, also rays of importance. The weight must be positive, even in
    // scenes without light, where no rays are traced.
    iteration.rays = std::max<std::int64_t>(1, traced);
    iteration.weight = iteration.rays;
    return estimate;
}

void Passes::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    state.rays.schedule.count_other_rays(iteration.rays_for_new_views);
    scale_history(state.light, iteration.history_factor);
    // Reset these only now, because an interrupted iteration is repeated.
    needs_importance_ = false;
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

Estimate Passes::trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines) {
    state.sampling.payloads = {};  // histogram of ray power; the report describes the last pass only
    const bool separates_direct = state.light.options().keep_direct;
    Pass pass{rays, oracle_refines, BounceBudget(rays, total_unshot_, separates_direct),
              importance_weights(state.light.solution, state.sampling.neighbourhoods, state.inputs.emission,
                                 state.sampling.part_importance)};
    pass.sums_leaves = state.light.forest->size() >= many_elements;
    pass.repeats_weights = state.light.forest->size() >= many_elements &&
                           weighs_by_indirect_importance(state.light.solution) &&
                           state.light.solution.indirect_importance == state.sampling.importance_at_start;
    pass.unshot_groups.assign(state.inputs.groups.size(), std::vector<Rgb>(state.light.forest->size(), Rgb(0)));
    if (!oracle_refines) pass.reflecting_where_received = leaves_reflecting_where_received(state);

    // The budget plans the last bounce when few rays or little unshot power are left
    while (!pass.budget.has_planned_last_bounce())
        if (!trace_bounce(state, pass)) break;
    total_unshot_ = pass.budget.total_unshot();

    Estimate& sum = pass.sum;
    if (sum.irradiance.empty()) sum = zero_estimate(state.inputs, state.light);  // no bounce had power to shoot
    pass.expand_sum(*state.light.forest);
    // Compute the inner elements from their children.
    if (!oracle_refines || pass.sums_leaves) pull(*state.light.forest, sum.irradiance);
    if (!oracle_refines) {  // rays deposit on leaves only
        pull_variance(*state.light.forest, sum.variance);
        pull(*state.light.forest, sum.groups);
        pull(*state.light.forest, sum.direct);
    }
    return std::move(sum);
}

bool Passes::trace_bounce(SolverState& state, Pass& pass) {
    Solution& solution = state.light.solution;
    const auto& experimental = state.light.options().experimental;
    // Plan sampling probabilities. Only the first bounce transports importance, because it has the most rays
    const bool carries_importance =
        pass.emits && importance_use(solution) == ImportanceUse::full && !experimental.separate_iterations;
    const Radiosity radiosity(state.inputs.materials, pass.unshot, pass.emits);
    if (pass.repeats_weights && !pass.emits)
        pass.weights.elements = element_weights(solution, state.sampling.importance_at_start);
    PowerPlan bounce = plan_power(state.inputs.materials, state.inputs.emission, solution, radiosity, pass.weights,
                                  carries_importance, /*rays=*/0);
    if (pass.repeats_weights) pass.weights.elements = std::vector<float>();
    solution.non_finite += bounce.non_finite_leaves;
    if (pass.emits) {
        pass.first_power = bounce.power;
        pass.first_weighted_power = bounce.weighted_power;
    }
    // Choose the number of rays by the power that is left
    if (!(bounce.power > 0)) return false;
    const BounceRays rays = pass.budget.next(pass.relative_unshot(bounce, experimental.beta));
    assert(rays.expected > 0);  // trace_pass() ends when the budget is spent
    bounce.plan.rays = rays.started;
    // Trace the rays, which may create elements. Random walks reflect those of the last bounce further, so more rays
    // are expected than started. Derived classes trace other bounces in their own way
    TransportStep step = pass.make_step(state, std::move(bounce.plan));
    const std::uint32_t old_elements = state.light.forest->size();
    // Views are not needed without importance
    if (old_elements >= many_elements && !carries_importance) solution.view_importance = std::vector<float>();
    Received received =
        step.completes_by_walks ? run_step(state, std::move(step)) : trace_single_bounce(state, std::move(step));
    if (solution.view_importance.empty() && !state.sampling.view.empty())
        set_view_importance(state.light, state.sampling);
    count_rays(state.rays, rays.expected, carries_importance, experimental.alpha);
    state.sampling.payloads += received.payloads;
    if (carries_importance) {
        // Merge importance now, because the oracle uses it in the next bounces. Its weight is rays.expected
        const TracedIteration bounce_alone{.plan = {.rays = rays.expected}};
        merge_importance(state.light, state.rays, received.importance, bounce_alone);
    }
    // Add the received light to the sum of all bounces
    pass.expand_sum(*state.light.forest);
    pass.grow(*state.light.forest, old_elements);
    pass.add_bounce(std::move(received), state.light.options().keep_direct);
    if (pass.sums_leaves) pass.reduce_sum_to_leaves(*state.light.forest);
    return true;
}

void Passes::make_first_estimate(SolverState& state) {
    make_initial_mesh(state);
    set_estimate(state.light, trace_pass(state, state.rays.schedule.start_rays(), /*oracle_refines=*/false));
    state.light.solution.direct.clear();  // the method that continues does not separate direct light
    state.rays.schedule.record_start(/*averaged_rays=*/0, rays_so_far(state.rays));
    append_report(state, 0);
}

void Passes::change_views(SolverState& state) {
    const Solution& solution = state.light.solution;
    const bool old_views_use_importance = importance_use(solution) == ImportanceUse::full;
    // If the views change repeatedly before an iteration, keep the first record: it describes the averaged rays.
    if (old_views_use_importance && state.rays.schedule.averaged_rays() > 0 && view_change_.empty())
        view_change_.record(state);
    IterationMethod::change_views(state);
    // Before the first iteration, prepare() transports importance.
    const bool has_begun = !solution.iterations.empty();
    const bool new_views_use_importance = importance_use(solution) == ImportanceUse::full;
    needs_importance_ = has_begun && new_views_use_importance;
    if (!needs_importance_) view_change_.clear();
}

void Passes::archive(StateArchive& archive) {
    // Members may be renamed, but their names in files stay.
    archive.amounts("passes/bounces", total_unshot_);
    archive("passes/finds_importance", needs_importance_);
    view_change_.archive(archive);
}

bool Passes::is_consistent(const SolverState& state) const { return view_change_.is_consistent(state); }

/// Factory of the table of methods (table.cpp): iterations are passes, or single bounces for comparison.
std::unique_ptr<IterationMethod> make_ray_radiosity(SolverState& state) {
    if (state.light.options().experimental.one_bounce) return std::make_unique<OneBounce>();
    return std::make_unique<Passes>();
}

}  // namespace interflect::detail
