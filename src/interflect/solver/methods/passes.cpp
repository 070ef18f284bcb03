#include "interflect/solver/methods/passes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "interflect/base/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/light_targets.h"
#include "interflect/solver/merge.h"
#include "interflect/solver/methods/bounce_budget.h"
#include "interflect/solver/methods/one_bounce.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/variance_refinement.h"

namespace interflect::inline detail {

namespace {

/// Minimum number of rays of a run that prepares before its first iteration.
constexpr std::int64_t fewest_rays_with_preparation = 4;
/// The initial transport of importance ends when at most this share is unshot.
constexpr double negligible_importance = 0.005;

/// Returns the unshot power of a bounce relative to the first one, partly weighted by importance. Rays are distributed
/// over the bounces by this number.
double unshot_weight(const PowerStep& bounce, double first_power, double first_weighted_power, double beta) {
    const auto relative = [](double a, double b) { return b > 0 ? a / b : 0; };
    const double power = relative(bounce.power, first_power);
    if (!(first_weighted_power > 0)) return power;
    return beta * power + (1 - beta) * relative(bounce.weighted_power, first_weighted_power);
}

FreshEstimate darkness(const SolverState& state) {
    FreshEstimate dark{std::vector<Rgb>(state.forest->size(), Rgb(0)), std::vector<float>(state.forest->size(), 0.0f)};
    dark.groups.assign(state.groups.size(), dark.irradiance);
    return dark;
}

void add(FreshEstimate& sum, Received& received) {
    accumulate(sum.groups, received.groups);
    if (sum.irradiance.empty()) {
        sum.irradiance = received.irradiance;
        sum.variance = std::move(received.variance);
        return;
    }
    parallel_for_ranges(sum.irradiance.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            sum.irradiance[e] += received.irradiance[e];
            sum.variance[e] += received.variance[e];
        }
    });
}

void set_estimate(SolverState& state, FreshEstimate estimate) {
    state.solution.irradiance = std::move(estimate.irradiance);
    state.solution.groups = std::move(estimate.groups);
}

std::int64_t rays_so_far(const SolverState& state) { return state.power_rays + state.importance_rays; }

}  // namespace

/// A pass while it is traced.
struct Passes::Pass {
    const std::int64_t rays;
    const bool oracle_refines;
    BounceBudget budget;
    ImportanceWeights weights;
    std::vector<std::uint8_t> reflecting_where_received = {};  ///< leaves_that_blur().
    bool emits = true;                                         ///< Whether the next bounce is the first.
    std::vector<Rgb> unshot = {};  ///< Irradiance of the last bounce, which the next one reflects.
    GroupLight unshot_groups = {};
    StartPoints start_points = {};                     ///< Origins of the next bounce.
    double first_power = 0, first_weighted_power = 0;  ///< See PowerStep; of the first bounce.
    FreshEstimate fresh = {};                          ///< Sum of the bounces.
    RgbD escaped_power{0, 0, 0};
};

namespace {

/// Transports importance from the views bounce by bounce with about `rays` rays. Adds each bounce to the estimate.
void find_importance(SolverState& state, std::int64_t rays) {
    Solution& solution = state.solution;
    std::vector<float> unshot = solution.view_importance;
    BounceBudget budget(rays, 0);
    double left = 1;  // sum of the importance received in a bounce; initially all of V
    while (left > negligible_importance && !budget.is_last()) {
        TransportStep step = importance_step(state.materials, solution, Importance(unshot),
                                             std::max<std::int64_t>(1, budget.next(left).expected));
        state.importance_rays += step.rays;
        unshot = run_step(state, std::move(step)).importance;
        left = 0;
        for (std::uint32_t e = 0; e < state.forest->size(); ++e) {
            solution.indirect_importance[e] += unshot[e];
            if (e < state.forest->patch_count()) left += static_cast<double>(unshot[e]) * state.forest->area(e);
        }
    }
}

}  // namespace

/// Traces one bounce and adds it to the pass. @return Whether it had light to trace.
bool Passes::trace_bounce(SolverState& state, Pass& pass) {
    Solution& solution = state.solution;
    // Only the first bounce, which has the most rays, transports importance.
    const bool carries_importance = pass.emits && importance_use(solution) == ImportanceUse::full &&
                                    !state.options.experimental.separate_iterations;
    const Radiosity light(state.materials, pass.unshot, pass.emits);
    PowerStep bounce =
        power_step(state.materials, state.emission, solution, light, pass.weights, carries_importance, 0);
    solution.non_finite += bounce.lost_leaves;
    if (pass.emits) pass.first_power = bounce.power, pass.first_weighted_power = bounce.weighted_power;
    const double weight =
        unshot_weight(bounce, pass.first_power, pass.first_weighted_power, state.options.experimental.beta);
    const BounceRays rays = bounce.power > 0 ? pass.budget.next(weight) : BounceRays();
    if (rays.expected == 0) return false;
    TransportStep& step = bounce.step;
    step.rays = rays.started;
    step.to_the_end = pass.budget.is_last();  // random walks complete a pass in every method
    step.reflecting_where_received = pass.reflecting_where_received;
    step.start_points = &pass.start_points;
    step.groups = group_radiosity(state, pass.unshot_groups, pass.emits);
    step.known_light = Radiosity(state.materials, solution.irradiance);
    step.leaves_only = !pass.oracle_refines;
    if (pass.oracle_refines)
        step.oracle = make_oracle(solution, state.schedule.averaged_rays() + pass.rays, state.floor.unseen());
    step.spent = &pass.unshot;
    const std::uint32_t before = state.forest->size();
    Received received = step.to_the_end ? run_step(state, std::move(step)) : trace(state, std::move(step));

    const double share = carries_importance ? state.options.experimental.alpha : 0;
    const std::int64_t for_importance = std::llround(share * static_cast<double>(rays.expected));
    state.importance_rays += for_importance;
    state.power_rays += rays.expected - for_importance;
    state.quanta += received.quanta;
    pass.escaped_power += received.escaped_power;
    if (!pass.fresh.irradiance.empty()) {
        inherit(*state.forest, before, pass.fresh.irradiance);
        inherit(*state.forest, before, pass.fresh.variance);
        inherit(*state.forest, before, pass.fresh.groups);
    }
    if (!pass.weights.elements.empty()) inherit(*state.forest, before, pass.weights.elements);
    add(pass.fresh, received);
    if (carries_importance)
        merge(state, solution.indirect_importance, received.importance, IterationPlan{.rays = rays.expected});
    pass.emits = false;
    pass.start_points = std::move(received.start_points);
    pass.unshot = std::move(received.irradiance);
    pass.unshot_groups = std::move(received.groups);
    return true;
}

/// @param oracle_refines Whether Eq. 14 and 15 refine the mesh during the pass; otherwise the mesh is fixed.
/// @throws Interrupted
Passes::Pass Passes::trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines) {
    state.quanta = {};
    Pass pass{rays, oracle_refines, BounceBudget(rays, bounces_),
              importance_weights(state.solution, state.neighbourhoods, state.emission, state.part_importance)};
    pass.unshot.assign(state.forest->size(), Rgb(0));
    pass.unshot_groups.assign(state.groups.size(), pass.unshot);
    if (!oracle_refines) pass.reflecting_where_received = leaves_that_blur(state);
    while (!pass.budget.is_last() && trace_bounce(state, pass)) {
    }
    bounces_ = pass.budget.bounces();
    FreshEstimate& fresh = pass.fresh;
    if (fresh.irradiance.empty()) fresh = darkness(state);  // no power to shoot
    if (!oracle_refines) {
        pull(*state.forest, fresh.irradiance), pull_variance(*state.forest, fresh.variance);
        pull(*state.forest, fresh.groups);
    }
    return pass;
}

void Passes::prepare(SolverState& state) {
    if (state.options.limits.rays < fewest_rays_with_preparation) return;
    const std::int64_t rays = state.schedule.start_rays();
    bounces_ = 0;
    set_estimate(state, darkness(state));  // an interrupted preparation may have left light
    if (importance_use(state.solution) == ImportanceUse::full) find_importance(state, rays);
    state.importance_rays += aim_outdoor_light(state);
    RgbD escaped_power(0, 0, 0);
    if (state.options.method.refines)
        for (const bool oracle_refines : {false, true}) {
            Pass pass = trace_pass(state, rays, oracle_refines);
            set_estimate(state, std::move(pass.fresh));
            escaped_power = pass.escaped_power;
        }
    state.importance_rays += aim_outdoor_light(state);  // importance is more accurate now
    state.schedule.began_with(0, rays_so_far(state));
    if (rays_so_far(state) > 0) report(state, 0, escaped_power);
}

void Passes::make_first_estimate(SolverState& state) {
    prepare(state);
    Pass pass = trace_pass(state, state.schedule.start_rays(), false);
    set_estimate(state, std::move(pass.fresh));
    state.schedule.began_with(0, rays_so_far(state));
    report(state, 0, pass.escaped_power);
}

namespace {

/// Returns the probabilities with which power rays start on the elements; excludes luminaires.
std::vector<float> power_sampling(const SolverState& state) {
    const Radiosity light(state.materials, state.solution.irradiance);
    const ImportanceWeights weights =
        importance_weights(state.solution, state.neighbourhoods, state.emission, state.part_importance);
    std::vector<float> q = power_step(state.materials, state.emission, state.solution, light, weights, false, 0).step.q;
    q.resize(state.forest->size());
    return q;
}

std::vector<float> patch_importance(const SolverState& state) {
    const Importance psi = importance_of(state.solution);
    std::vector<float> values;
    for (std::uint32_t i = 0; i < state.forest->patch_count(); ++i) values.push_back(psi[i]);
    return values;
}

/// Returns the ratio of the new to the old variance per ray, as seen by some views. The payloads of a source are
/// proportional to its power over its share of the rays, and are weighted by its importance.
/// @param importance Of patches.
float noise_ratio(const SolverState& state, const std::vector<float>& importance, const std::vector<float>& old_q,
                  const std::vector<float>& new_q) {
    constexpr double largest = 256;
    const ElementForest& forest = *state.forest;
    const Radiosity light(state.materials, state.solution.irradiance);
    double before = 0, now = 0;
    for (std::uint32_t e = 0; e < forest.size(); ++e) {
        if (!forest.is_leaf(e) || !(old_q[e] > 0) || !(new_q[e] > 0)) continue;
        const double power = static_cast<double>(channel_sum(light.of(forest, e))) * forest.area(e);
        const double matters = power * importance[forest.patch(e)];
        before += matters * power / old_q[e];
        now += matters * power / new_q[e];
    }
    return before > 0 ? static_cast<float>(std::clamp(now / before, 1 / largest, largest)) : 1.0f;
}

/// @param factor  One for each patch, or empty.
void scale_history(SolverState& state, const std::vector<float>& factor) {
    if (factor.empty()) return;
    for (std::uint32_t e = 0; e < state.history.size(); ++e) state.history[e] *= factor[state.forest->patch(e)];
    state.noise.scale_by_patch(*state.forest, factor);
}

}  // namespace

void Passes::retarget(SolverState& state) {
    const ImportanceUse before = importance_use(state.solution);
    const bool keeps_light = state.schedule.averaged_rays() > 0 && before == ImportanceUse::full;
    if (keeps_light && old_q_.empty()) {
        old_q_ = power_sampling(state);
        old_importance_ = patch_importance(state);
    }
    IterationMethod::retarget(state);
    finds_importance_ = !state.solution.iterations.empty() && importance_use(state.solution) == ImportanceUse::full;
    if (!finds_importance_) old_q_.clear(), old_importance_.clear();
}

/// Computes importance for the new views. @return Factor of each patch's history, which becomes the number of new rays
/// with the same noise: it shrinks where the new views increase the ray density and grows elsewhere. Empty: 1.
std::vector<float> Passes::adapt_to_views(SolverState& state) const {
    find_importance(state, state.schedule.start_rays());
    state.importance_rays += aim_outdoor_light(state);
    std::vector<float> old_q = old_q_;
    if (old_q.empty()) return {};
    for (auto e = static_cast<std::uint32_t>(old_q.size()); e < state.forest->size(); ++e)
        old_q.push_back(old_q[state.forest->parent(e)] / 4);  // elements created since then
    const std::vector<float> new_q = power_sampling(state), new_psi = patch_importance(state);
    const float here = noise_ratio(state, new_psi, old_q, new_q);
    const float there = noise_ratio(state, old_importance_, old_q, new_q);
    std::vector<float> ratio(state.forest->patch_count());
    for (std::uint32_t i = 0; i < ratio.size(); ++i) {
        const float both = new_psi[i] + old_importance_[i], share = both > 0 ? new_psi[i] / both : 0.5f;
        ratio[i] = std::exp(share * std::log(here) + (1 - share) * std::log(there));
    }
    return ratio;
}

RgbD Passes::iterate(SolverState& state, IterationPlan& plan) {
    const bool has_importance_step =
        importance_use(state.solution) == ImportanceUse::full && state.options.experimental.separate_iterations;
    const std::int64_t for_importance =
        has_importance_step ? std::llround(state.options.experimental.alpha * static_cast<double>(plan.rays)) : 0;
    const std::int64_t rays_before_adaptation = rays_so_far(state);
    std::vector<float> change_of_history;
    if (finds_importance_) change_of_history = adapt_to_views(state);
    const std::int64_t rays_before = rays_so_far(state);
    if (for_importance > 0) {
        const Importance psi = importance_of(state.solution);
        const Received received =
            run_step(state, importance_step(state.materials, state.solution, psi, for_importance));
        merge(state, state.solution.indirect_importance, received.importance, plan);
        state.importance_rays += for_importance;
    }
    const std::uint32_t elements_before = state.forest->size();
    const bool by_power = state.options.method.refines && !refines_by_variance(state.options);
    std::optional<Pass> pass;
    if (plan.rays > for_importance) pass.emplace(trace_pass(state, plan.rays - for_importance, by_power));

    // The remaining work is not interrupted.
    state.schedule.count_other_rays(rays_before - rays_before_adaptation);
    scale_history(state, change_of_history);
    finds_importance_ = false;
    old_q_.clear(), old_importance_.clear();
    if (!pass) return state.escaped_power;
    plan.rays = std::max<std::int64_t>(1, rays_so_far(state) - rays_before);
    estimate_noise(state, pass->fresh, plan.rays);
    merge_details(state, state.solution.irradiance, pass->fresh.irradiance, plan);
    merge_details(state, state.solution.groups, pass->fresh.groups, plan);
    merge_escaped_power(state, pass->escaped_power, plan);
    update_history(state, plan, elements_before);
    if (state.options.method.refines && !by_power && state.noise.is_known()) refine_by_variance(state);
    return state.escaped_power;
}

void Passes::archive(StateArchive& archive) {
    archive("passes/bounces", bounces_);
    archive("passes/finds_importance", finds_importance_);
    archive("passes/old_q", old_q_);
    archive("passes/old_importance", old_importance_);
}

bool Passes::fits(const SolverState& state) const {
    const std::uint32_t patches = state.forest->patch_count();
    return old_q_.empty() ||
           (old_q_.size() >= patches && old_q_.size() <= state.forest->size() && old_importance_.size() == patches);
}

std::unique_ptr<IterationMethod> make_ray_radiosity(SolverState& state) {
    if (state.options.experimental.one_bounce) return std::make_unique<OneBounce>();
    return std::make_unique<Passes>();
}

}  // namespace interflect::inline detail
