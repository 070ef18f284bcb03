#include "interflect/solver/methods/passes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/light_targets.h"
#include "interflect/solver/merge.h"
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
double unshot_weight(const PowerStep& bounce, const Pass& pass, double beta) {
    const auto relative = [](double a, double b) { return b > 0 ? a / b : 0; };
    const double power = relative(bounce.power, pass.first_power);
    if (!(pass.first_weighted_power > 0)) return power;
    return beta * power + (1 - beta) * relative(bounce.weighted_power, pass.first_weighted_power);
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

/// Transports importance from the views bounce by bounce with about `rays` rays. Adds each bounce to the estimate.
void Passes::start_importance(SolverState& state, std::int64_t rays) {
    Solution& solution = state.solution;
    ImportanceStart& start = importance_;
    if (!start.is_under_way) start = {true, solution.view_importance, BounceBudget(rays, 0), 1};
    while (start.left > negligible_importance && !start.budget.is_last()) {
        BounceBudget budget = start.budget;
        TransportStep step = importance_step(state.materials, solution, Importance(start.unshot),
                                             std::max<std::int64_t>(1, budget.next(start.left).expected));
        const std::int64_t traced = step.rays;
        start.unshot = run_step(state, std::move(step)).importance;
        start.budget = budget;
        state.importance_rays += traced;
        start.left = 0;  // sum of the importance received in this bounce; initially all of V
        for (std::uint32_t e = 0; e < state.forest->size(); ++e) {
            solution.indirect_importance[e] += start.unshot[e];
            if (e < state.forest->patch_count())
                start.left += static_cast<double>(start.unshot[e]) * state.forest->area(e);
        }
    }
    start = {};
}

void Passes::begin_pass(SolverState& state, std::int64_t rays, bool oracle_refines) {
    pass_ = {};
    pass_.is_under_way = true;
    escaped_power_ = RgbD(0, 0, 0);
    pass_.budget = BounceBudget(rays, bounces_);
    pass_.weights = importance_weights(state.solution, state.neighbourhoods, state.emission, state.part_importance);
    pass_.unshot.assign(state.forest->size(), Rgb(0));
    pass_.unshot_groups.assign(state.groups.size(), pass_.unshot);
    if (!oracle_refines) pass_.reflecting_where_received = leaves_that_blur(state);
    state.quanta = {};
}

/// Traces one bounce of a pass of `rays` rays and adds it to the pass.
/// @return Number of traced rays; 0: the pass has ended.
std::int64_t Passes::trace_bounce(SolverState& state, std::int64_t rays, bool oracle_refines) {
    Solution& solution = state.solution;
    // Only the first bounce, which has the most rays, transports importance.
    const bool carries_importance = pass_.emits && importance_use(solution) == ImportanceUse::full &&
                                    !state.options.experimental.separate_iterations;
    const Radiosity light(state.materials, pass_.unshot, pass_.emits);
    PowerStep bounce =
        power_step(state.materials, state.emission, solution, light, pass_.weights, carries_importance, 0);
    if (pass_.emits) pass_.first_power = bounce.power, pass_.first_weighted_power = bounce.weighted_power;
    BounceBudget budget = pass_.budget;
    const double weight = unshot_weight(bounce, pass_, state.options.experimental.beta);
    const BounceRays rays_of_bounce = bounce.power > 0 ? budget.next(weight) : BounceRays();
    const std::int64_t traced = rays_of_bounce.expected;
    TransportStep& step = bounce.step;
    step.rays = rays_of_bounce.started;
    step.to_the_end = budget.is_last();
    step.reflecting_where_received = pass_.reflecting_where_received;
    step.start_points = &pass_.start_points;
    step.groups = group_radiosity(state, pass_.unshot_groups, pass_.emits);
    step.known_light = Radiosity(state.materials, solution.irradiance);
    step.leaves_only = !oracle_refines;
    if (oracle_refines)
        step.oracle = make_oracle(solution, state.schedule.averaged_rays() + rays, state.floor.unseen());
    step.spent = &pass_.unshot;
    const std::uint32_t before = state.forest->size();
    Received received;
    // Random walks complete a pass in every method.
    if (traced > 0) received = step.to_the_end ? run_step(state, std::move(step)) : trace(state, std::move(step));

    pass_.budget = budget;
    pass_.emits = false;
    solution.non_finite += bounce.lost_leaves;
    if (traced == 0) return 0;
    const double share = carries_importance ? state.options.experimental.alpha : 0;
    const std::int64_t for_importance = std::llround(share * static_cast<double>(traced));
    state.importance_rays += for_importance;
    state.power_rays += traced - for_importance;
    state.quanta += received.quanta;
    escaped_power_ += received.escaped_power;
    if (!pass_.fresh.irradiance.empty()) {
        inherit(*state.forest, before, pass_.fresh.irradiance);
        inherit(*state.forest, before, pass_.fresh.variance);
        inherit(*state.forest, before, pass_.fresh.groups);
    }
    if (!pass_.weights.elements.empty()) inherit(*state.forest, before, pass_.weights.elements);
    add(pass_.fresh, received);
    if (carries_importance)
        merge(state, solution.indirect_importance, received.importance, IterationPlan{.rays = traced});
    pass_.start_points = std::move(received.start_points);
    pass_.unshot = std::move(received.irradiance);
    pass_.unshot_groups = std::move(received.groups);
    return traced;
}

/// @param oracle_refines Whether Eq. 14 and 15 refine the mesh during the pass; otherwise the mesh is fixed.
FreshEstimate Passes::trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines) {
    if (!pass_.is_under_way) begin_pass(state, rays, oracle_refines);
    while (!pass_.budget.is_last() && trace_bounce(state, rays, oracle_refines) > 0) {
    }
    FreshEstimate fresh = std::move(pass_.fresh);
    if (fresh.irradiance.empty())  // no power to shoot
        fresh = {std::vector<Rgb>(state.forest->size(), Rgb(0)), std::vector<float>(state.forest->size(), 0.0f),
                 GroupLight(state.groups.size(), std::vector<Rgb>(state.forest->size(), Rgb(0)))};
    bounces_ = pass_.budget.bounces();
    pass_ = {};
    if (oracle_refines) return fresh;
    pull(*state.forest, fresh.irradiance), pull_variance(*state.forest, fresh.variance);
    pull(*state.forest, fresh.groups);
    return fresh;
}

void Passes::prepare(SolverState& state) {
    if (state.options.limits.rays < fewest_rays_with_preparation) stage_ = Stage::done;
    const std::int64_t rays = state.schedule.start_rays();
    if (stage_ == Stage::importance) {
        if (importance_use(state.solution) == ImportanceUse::full) start_importance(state, rays);
        state.importance_rays += aim_outdoor_light(state);
        stage_ = Stage::coarse_pass;
    }
    for (const Stage pass : {Stage::coarse_pass, Stage::refining_pass}) {
        if (stage_ != pass) continue;
        if (state.options.method.refines) set_estimate(state, trace_pass(state, rays, pass == Stage::refining_pass));
        stage_ = pass == Stage::coarse_pass ? Stage::refining_pass : Stage::report;
    }
    if (stage_ == Stage::report) {
        state.importance_rays += aim_outdoor_light(state);  // importance is more accurate now
        state.schedule.began_with(0, rays_so_far(state));
        if (rays_so_far(state) > 0) report(state, 0, escaped_power_);
        stage_ = Stage::done;
    }
}

void Passes::make_first_estimate(SolverState& state) {
    prepare(state);
    set_estimate(state, trace_pass(state, state.schedule.start_rays(), false));
    state.schedule.began_with(0, rays_so_far(state));
    report(state, 0, escaped_power_);
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

}  // namespace

void Passes::retarget(SolverState& state) {
    const ImportanceUse before = importance_use(state.solution);
    const bool keeps_light = state.schedule.averaged_rays() > 0 && before == ImportanceUse::full;
    if (keeps_light && old_q_.empty()) {
        old_q_ = power_sampling(state);
        old_importance_ = patch_importance(state);
    }
    IterationMethod::retarget(state);
    importance_ = {};
    if (pass_.is_under_way)
        pass_.weights = importance_weights(state.solution, state.neighbourhoods, state.emission, state.part_importance);
    finds_importance_ = stage_ != Stage::importance && importance_use(state.solution) == ImportanceUse::full;
    if (!finds_importance_) old_q_.clear(), old_importance_.clear();
}

/// Computes importance for the new views. The history becomes the number of new rays with the same noise: it shrinks
/// where the new views increase the ray density and grows elsewhere.
void Passes::adapt_to_views(SolverState& state) {
    if (!importance_.is_under_way) rays_before_adaptation_ = rays_so_far(state);
    start_importance(state, state.schedule.start_rays());
    state.importance_rays += aim_outdoor_light(state);
    finds_importance_ = false;
    state.schedule.count_other_rays(rays_so_far(state) - rays_before_adaptation_);
    std::vector<float> old_q = std::exchange(old_q_, {});
    const std::vector<float> old_psi = std::exchange(old_importance_, {});
    if (old_q.empty()) return;
    for (auto e = static_cast<std::uint32_t>(old_q.size()); e < state.forest->size(); ++e)
        old_q.push_back(old_q[state.forest->parent(e)] / 4);  // elements created since then
    const std::vector<float> new_q = power_sampling(state), new_psi = patch_importance(state);
    const float here = noise_ratio(state, new_psi, old_q, new_q), there = noise_ratio(state, old_psi, old_q, new_q);
    std::vector<float> ratio(state.forest->patch_count());
    for (std::uint32_t i = 0; i < ratio.size(); ++i) {
        const float both = new_psi[i] + old_psi[i], share = both > 0 ? new_psi[i] / both : 0.5f;
        ratio[i] = std::exp(share * std::log(here) + (1 - share) * std::log(there));
    }
    for (std::uint32_t e = 0; e < state.history.size(); ++e) state.history[e] *= ratio[state.forest->patch(e)];
    state.noise.scale_by_patch(*state.forest, ratio);
}

void Passes::scale_group(SolverState&, std::size_t /*group*/, float /*factor*/) { pass_ = {}; }

void Passes::archive(StateArchive& archive) {
    archive("passes/stage", stage_);
    archive("passes/importance/is_under_way", importance_.is_under_way);
    archive("passes/importance/unshot", importance_.unshot);
    importance_.budget.archive(archive, "passes/importance/budget");
    archive("passes/importance/left", importance_.left);
    archive("passes/pass/is_under_way", pass_.is_under_way);
    archive("passes/pass/emits", pass_.emits);
    archive("passes/pass/irradiance", pass_.fresh.irradiance);
    archive("passes/pass/variance", pass_.fresh.variance);
    archive("passes/pass/unshot", pass_.unshot);
    archive("passes/pass/weights", pass_.weights.elements);
    archive("passes/pass/nearby", pass_.weights.nearby);
    archive("passes/pass/parts", pass_.weights.parts);
    archive("passes/pass/parts_nearby", pass_.weights.parts_nearby);
    pass_.budget.archive(archive, "passes/pass/budget");
    archive("passes/pass/first_power", pass_.first_power);
    archive("passes/pass/first_weighted_power", pass_.first_weighted_power);
    archive("passes/pass/reflecting_where_received", pass_.reflecting_where_received);
    pass_.start_points.archive(archive, "passes/pass/start_points");
    archive_groups(archive, "passes/pass/groups", pass_.fresh.groups);
    archive_groups(archive, "passes/pass/unshot_groups", pass_.unshot_groups);
    archive("passes/bounces", bounces_);
    archive("passes/finds_importance", finds_importance_);
    archive("passes/old_q", old_q_);
    archive("passes/old_importance", old_importance_);
    archive("passes/rays_before_adaptation", rays_before_adaptation_);
    archive("passes/escaped_power", escaped_power_);
    archive("passes/importance_step_is_done", importance_step_is_done_);
    archive("passes/rays_before", rays_before_);
    archive("passes/elements_before", elements_before_);
}

bool Passes::fits(const SolverState& state) const {
    const ElementForest& forest = *state.forest;
    const auto has_parts = [&](const auto& numbers) {
        return numbers.empty() || numbers.size() == state.emission.part_count();
    };
    const auto is_whole = [&](const auto& numbers) { return numbers.empty() || numbers.size() == forest.size(); };
    const auto has_groups = [&](const GroupLight& light) {
        return light.empty() ||
               (light.size() == state.groups.size() && std::all_of(light.begin(), light.end(), is_whole));
    };
    const bool pass_fits = !pass_.is_under_way || pass_.unshot.size() == forest.size();
    const bool importance_fits = !importance_.is_under_way || importance_.unshot.size() == forest.size();
    return stage_ >= Stage::importance && stage_ <= Stage::done && pass_fits && importance_fits &&
           is_whole(pass_.fresh.irradiance) && is_whole(pass_.fresh.variance) && is_whole(pass_.weights.elements) &&
           has_groups(pass_.fresh.groups) && has_groups(pass_.unshot_groups) &&
           is_whole(pass_.reflecting_where_received) && pass_.start_points.fit(forest.size()) &&
           old_q_.size() <= forest.size() &&
           (old_q_.empty() ||
            (old_q_.size() >= forest.patch_count() && old_importance_.size() == forest.patch_count())) &&
           (pass_.weights.nearby.empty() || pass_.weights.nearby.size() == forest.patch_count()) &&
           has_parts(pass_.weights.parts) && has_parts(pass_.weights.parts_nearby) && elements_before_ <= forest.size();
}

RgbD Passes::iterate(SolverState& state, IterationPlan& plan) {
    const bool has_importance_step =
        importance_use(state.solution) == ImportanceUse::full && state.options.experimental.separate_iterations;
    const std::int64_t for_importance =
        has_importance_step ? std::llround(state.options.experimental.alpha * static_cast<double>(plan.rays)) : 0;
    if (finds_importance_ && !importance_step_is_done_) adapt_to_views(state);
    if (!importance_step_is_done_) {
        rays_before_ = rays_so_far(state);
        if (for_importance > 0) {
            const Importance psi = importance_of(state.solution);
            const Received received =
                run_step(state, importance_step(state.materials, state.solution, psi, for_importance));
            merge(state, state.solution.indirect_importance, received.importance, plan);
            state.importance_rays += for_importance;
        }
        elements_before_ = state.forest->size();
        importance_step_is_done_ = true;
    }
    if (plan.rays > for_importance) {
        const bool by_power = state.options.method.refines && !refines_by_variance(state.options);
        const FreshEstimate fresh = trace_pass(state, plan.rays - for_importance, by_power);
        plan.rays = std::max<std::int64_t>(1, rays_so_far(state) - rays_before_);
        estimate_noise(state, fresh, plan.rays);
        merge_details(state, state.solution.irradiance, fresh.irradiance, plan);
        merge_details(state, state.solution.groups, fresh.groups, plan);
        merge_escaped_power(state, escaped_power_, plan);
        update_history(state, plan, elements_before_);
        if (state.options.method.refines && !by_power && state.noise.is_known()) {
            refine_by_variance(state);
        }
    }
    importance_step_is_done_ = false;
    return state.escaped_power;
}

std::unique_ptr<IterationMethod> make_ray_radiosity(SolverState& state) {
    if (state.options.experimental.one_bounce) return std::make_unique<OneBounce>();
    return std::make_unique<Passes>();
}

}  // namespace interflect::inline detail
