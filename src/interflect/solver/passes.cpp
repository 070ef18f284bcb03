#include "interflect/solver/passes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/parallel.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/merge.h"
#include "interflect/solver/steps.h"
#include "interflect/solver/variance_refinement.h"

namespace interflect {

namespace {

/// A pass ends when the next bounce would get fewer rays; the next pass shoots what is left.
constexpr double fewest_rays_of_bounce = 16;
/// Or when what is left, with all its bounces, is less than this share of the pass: every bounce takes time for every
/// element.
constexpr double least_share_left = 0.05;
/// Before a pass has told: the sum over all bounces of what is left to shoot, relative to the first.
constexpr double assumed_bounces = 2;
/// What is left to shoot is expected to fall by such factors from one bounce to the next: before it is known; where it
/// has just grown, as it may while light spreads towards the view; and at most.
constexpr double decay_at_first = 0.1, decay_while_it_grows = 0.9, most_decay = 0.99;
/// With fewer rays in all there is none to spare before the first iteration.
constexpr std::int64_t fewest_rays_with_preparation = 4;
/// Importance is followed at first until this share of it is left.
constexpr double negligible_importance = 0.005;

/// MixtureWeights the rays of a pass among its bounces.
class BounceBudget {
  public:
    /// @param bounces   Sum over all bounces of what is left to shoot, relative to the first; 0: not known.
    /// @param is_final  No other pass will shoot what this one leaves.
    BounceBudget(std::int64_t rays, double bounces, bool is_final)
        : rays_(rays),
          left_(rays),
          bounces_(bounces > 0 ? bounces : assumed_bounces),
          fewest_(is_final ? 1 : fewest_rays_of_bounce),
          least_left_(is_final ? 0 : least_share_left * bounces_) {}

    /// @param unshot  What is left to shoot, relative to the first bounce.
    /// @return        The rays of the next bounce; all that are left if it is the last; 0 if there are none.
    std::int64_t next(double unshot) {
        const double left = static_cast<double>(left_), all = static_cast<double>(rays_);
        // If all bounces to come decay alike, they must do with what is left.
        const double fall = last_unshot_ > 0 ? unshot / last_unshot_ : decay_at_first;
        decay_ = fall < 1 ? std::min(most_decay, fall) : decay_while_it_grows;
        last_unshot_ = unshot;
        const double share = all * unshot / bounces_;
        is_last_ = share < fewest_ || left < fewest_ || unshot < (1 - fall) * least_left_;
        const double rays = is_last_ ? left : std::min(share, std::max(1.0, (1 - decay_) * left));
        const std::int64_t taken = std::min<std::int64_t>(left_, std::llround(rays));
        left_ -= taken;
        unshot_sum_ += unshot;
        return taken;
    }
    bool is_last() const { return is_last_ || left_ == 0; }
    /// Of this pass; what the bounces that it lacks would have to shoot is extrapolated.
    double bounces() const { return unshot_sum_ + last_unshot_ * decay_ / (1 - decay_); }

  private:
    std::int64_t rays_, left_;
    double bounces_, fewest_, least_left_;
    double last_unshot_ = 0, unshot_sum_ = 0, decay_ = 0;
    bool is_last_ = false;
};

/// What a bounce has to shoot, as a number that rays are shared by.
double unshot_weight(const PowerStep& bounce, const PowerStep& first, double beta) {
    const auto relative = [](double a, double b) { return b > 0 ? a / b : 0; };
    const double power = relative(bounce.power, first.power);
    if (!(first.weighted_power > 0)) return power;
    return beta * power + (1 - beta) * relative(bounce.weighted_power, first.weighted_power);
}

void add(FreshEstimate& sum, Received& received) {
    if (sum.irradiance.empty()) {
        sum = {received.irradiance, std::move(received.variance)};
        return;
    }
    parallel_for_ranges(sum.irradiance.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            sum.irradiance[e] += received.irradiance[e];
            sum.variance[e] += received.variance[e];
        }
    });
}

/// Follows importance bounce by bounce, with so many rays at first; what it finds at each is added to the estimate.
void start_importance(SolverState& state, std::int64_t rays) {
    Solution& solution = state.solution;
    BounceBudget budget(rays, 0, true);
    std::vector<float> unshot = solution.view_importance;
    for (double left = 1; left > negligible_importance && !budget.is_last();) {
        TransportStep step = importance_step(state.materials, solution, Importance(unshot),
                                             std::max<std::int64_t>(1, budget.next(left)));
        state.importance_rays += step.rays;
        unshot = run_step(state, std::move(step)).importance;
        left = 0;  // of the reflected importance; at first all of V is to be shot
        for (std::uint32_t e = 0; e < state.forest->size(); ++e) {
            solution.indirect_importance[e] += unshot[e];
            if (e < state.forest->patch_count()) left += static_cast<double>(unshot[e]) * state.forest->area(e);
        }
    }
}

/// Hands on what the pass did not shoot.
std::vector<Rgb> carried_over(PassState& passes, std::size_t elements, std::int64_t rays) {
    std::vector<Rgb> unshot = std::exchange(passes.unshot, {});
    if (unshot.empty()) unshot.assign(elements, Rgb(0));
    const auto factor = static_cast<float>(passes.unshot_rays / static_cast<double>(rays));
    for (Rgb& h : unshot) h *= factor;
    return unshot;
}

/// Traces one bounce and adds it to the pass; a pass that is empty becomes it. @return What is to be shot next: what it
/// brought.
std::vector<Rgb> trace_bounce(SolverState& state, TransportStep step, FreshEstimate& pass, RgbD& escaped_power) {
    const bool carries_importance = step.carries_importance();
    const IterationPlan plan{.rays = step.rays};
    const double share = carries_importance ? state.options.alpha : 0;
    const std::int64_t for_importance = std::llround(share * static_cast<double>(step.rays));
    state.importance_rays += for_importance;
    state.power_rays += step.rays - for_importance;
    const std::uint32_t before = state.forest->size();
    Received received = run_step(state, std::move(step));
    escaped_power += received.escaped_power;
    state.quanta += received.quanta;
    if (!pass.irradiance.empty()) {
        inherit(*state.forest, before, pass.irradiance);
        inherit(*state.forest, before, pass.variance);
    }
    add(pass, received);
    if (carries_importance) merge(state, state.solution.indirect_importance, received.importance, plan);
    return std::move(received.irradiance);
}

}  // namespace

FreshEstimate trace_pass(SolverState& state, PassState& passes, std::int64_t rays, bool oracle_refines,
                         RgbD& escaped_power) {
    Solution& solution = state.solution;
    const bool carries_importance =
        importance_use(solution) == ImportanceUse::full && !state.options.separate_iterations;
    BounceBudget budget(rays, passes.bounces, passes.is_final);
    FreshEstimate fresh;
    std::vector<Rgb> unshot = carried_over(passes, state.forest->size(), rays);
    ImportanceWeights weights = importance_weights(solution, state.neighbourhoods);
    PowerStep first;
    state.quanta = {};
    for (bool emits = true; !budget.is_last(); emits = false) {
        // Importance is carried on by the first bounce alone, which has the most rays.
        const Radiosity light(state.materials, unshot, emits);
        PowerStep bounce = power_step(state.materials, solution, light, weights, carries_importance && emits, 0);
        if (emits) first = {{}, bounce.power, bounce.weighted_power};
        const double weight = unshot_weight(bounce, first, state.options.beta);
        bounce.step.rays = bounce.power > 0 ? budget.next(weight) : 0;
        if (bounce.step.rays == 0) break;
        bounce.step.known_light = Radiosity(state.materials, solution.irradiance);
        bounce.step.leaves_only = !oracle_refines;
        if (oracle_refines)
            bounce.step.oracle = make_oracle(solution, state.schedule.averaged_rays() + rays, state.floor.unseen());
        bounce.step.spent = std::move(unshot);
        unshot = trace_bounce(state, std::move(bounce.step), fresh, escaped_power);
        if (!weights.elements.empty())
            inherit(*state.forest, static_cast<std::uint32_t>(weights.elements.size()), weights.elements);
    }
    if (fresh.irradiance.empty())  // nothing could be shot
        fresh = {std::vector<Rgb>(state.forest->size(), Rgb(0)), std::vector<float>(state.forest->size(), 0.0f)};
    passes.bounces = budget.bounces();
    passes.unshot = std::move(unshot);
    passes.unshot_rays = static_cast<double>(rays);
    if (!oracle_refines) pull(*state.forest, fresh.irradiance), pull_variance(*state.forest, fresh.variance);
    return fresh;
}

PassState prepare_passes(SolverState& state) {
    PassState passes;
    if (state.options.rays < fewest_rays_with_preparation) return passes;
    const std::int64_t rays = state.schedule.start_rays();
    if (importance_use(state.solution) == ImportanceUse::full) start_importance(state, rays);
    RgbD escaped_power(0, 0, 0);
    if (state.options.method.refines) {
        state.solution.irradiance = trace_pass(state, passes, rays, false, escaped_power).irradiance;
        PassState refined;
        refined.bounces = passes.bounces;
        state.solution.irradiance = trace_pass(state, refined, rays, true, escaped_power).irradiance;
        passes.bounces = refined.bounces;
    }
    passes.unshot.clear();
    const std::int64_t traced = state.power_rays + state.importance_rays;
    state.schedule.began_with(0, traced);
    if (traced > 0) report(state, 0, escaped_power);
    return passes;
}

void make_first_estimate(SolverState& state) {
    PassState passes = prepare_passes(state);
    passes.is_final = true;
    if (state.power_rays == 0) {
        RgbD escaped_power(0, 0, 0);
        state.solution.irradiance =
            trace_pass(state, passes, state.schedule.start_rays(), false, escaped_power).irradiance;
        state.schedule.began_with(0, state.power_rays + state.importance_rays);
        report(state, 0, escaped_power);
    }
}

RgbD iterate_pass(SolverState& state, PassState& passes, IterationPlan& plan) {
    RgbD escaped_power(0, 0, 0);
    const std::int64_t rays_before = state.power_rays + state.importance_rays;
    const bool has_importance_step =
        importance_use(state.solution) == ImportanceUse::full && state.options.separate_iterations;
    const std::int64_t for_importance =
        has_importance_step ? std::llround(state.options.alpha * static_cast<double>(plan.rays)) : 0;
    if (for_importance > 0) {
        const Importance psi = importance_of(state.solution);
        const Received received =
            run_step(state, importance_step(state.materials, state.solution, psi, for_importance));
        merge(state, state.solution.indirect_importance, received.importance, plan);
        state.importance_rays += for_importance;
    }
    if (plan.rays == for_importance) return escaped_power;
    passes.is_final = plan.is_final;
    const bool by_power = state.options.method.refines && !refines_by_variance(state.options);
    const std::uint32_t before = state.forest->size();
    const FreshEstimate fresh = trace_pass(state, passes, plan.rays - for_importance, by_power, escaped_power);
    plan.rays = std::max<std::int64_t>(1, state.power_rays + state.importance_rays - rays_before);
    estimate_noise(state, fresh, plan.rays);
    merge_details(state, state.solution.irradiance, fresh.irradiance, plan);
    update_history(state, plan, before);
    if (state.options.method.refines && !by_power && state.noise.is_known()) {
        const std::uint32_t size = state.forest->size();
        refine_by_variance(state);
        inherit(*state.forest, size, passes.unshot);
    }
    return escaped_power;
}

}  // namespace interflect
