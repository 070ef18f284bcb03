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

/// A pass ends when the next bounce would get fewer rays; what is left to shoot is handed on to the next pass.
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

/// Shares the rays of a pass among its bounces.
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
    if (!(first.driven_power > 0)) return power;
    return beta * power + (1 - beta) * relative(bounce.driven_power, first.driven_power);
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
void start_importance(Run& run, std::int64_t rays) {
    Solution& solution = run.solution;
    BounceBudget budget(rays, 0, true);
    std::vector<float> unshot = solution.view_importance;
    for (double left = 1; left > negligible_importance && !budget.is_last();) {
        TransportStep step =
            importance_step(run.surfaces, solution, Importance(unshot), std::max<std::int64_t>(1, budget.next(left)));
        run.importance_rays += step.rays;
        unshot = run_step(run, std::move(step)).importance;
        left = 0;  // of the reflected importance; at first all of V is to be shot
        for (std::uint32_t e = 0; e < run.forest->size(); ++e) {
            solution.indirect_importance[e] += unshot[e];
            if (e < run.forest->patch_count()) left += static_cast<double>(unshot[e]) * run.forest->area(e);
        }
    }
}

/// Hands on what the pass did not shoot.
std::vector<Rgb> handed_on(PassState& state, std::size_t elements, std::int64_t rays) {
    std::vector<Rgb> unshot = std::exchange(state.unshot, {});
    if (unshot.empty()) unshot.assign(elements, Rgb(0));
    const auto factor = static_cast<float>(state.unshot_rays / static_cast<double>(rays));
    for (Rgb& h : unshot) h *= factor;
    return unshot;
}

/// Traces one bounce and adds it to the pass; a pass that is empty becomes it. @return What is to be shot next: what it
/// brought.
std::vector<Rgb> trace_bounce(Run& run, TransportStep step, FreshEstimate& pass, RgbD& escaped_power) {
    const bool carries_importance = step.carries_importance();
    const IterationPlan plan{.rays = step.rays};
    const double share = carries_importance ? run.options.alpha : 0;
    const std::int64_t for_importance = std::llround(share * static_cast<double>(step.rays));
    run.importance_rays += for_importance;
    run.power_rays += step.rays - for_importance;
    const std::uint32_t before = run.forest->size();
    Received received = run_step(run, std::move(step));
    escaped_power += received.escaped_power;
    run.quanta += received.quanta;
    if (!pass.irradiance.empty()) {
        inherit(*run.forest, before, pass.irradiance);
        inherit(*run.forest, before, pass.variance);
    }
    add(pass, received);
    if (carries_importance) merge(run, run.solution.indirect_importance, received.importance, plan);
    return std::move(received.irradiance);
}

}  // namespace

FreshEstimate trace_pass(Run& run, PassState& state, std::int64_t rays, bool oracle_refines, RgbD& escaped_power) {
    Solution& solution = run.solution;
    const bool carries_importance = importance_use(solution) == ImportanceUse::full && !run.options.separate_iterations;
    BounceBudget budget(rays, state.bounces, state.is_final);
    FreshEstimate fresh;
    std::vector<Rgb> unshot = handed_on(state, run.forest->size(), rays);
    PowerDriver driver = power_driver(solution, run.neighbourhoods);
    PowerStep first;
    run.quanta = {};
    for (bool emits = true; !budget.is_last(); emits = false) {
        // Importance is carried on by the first bounce alone, which has the most rays.
        const Light light(run.surfaces, unshot, emits);
        PowerStep bounce = power_step(run.surfaces, solution, light, driver, carries_importance && emits, 0);
        if (emits) first = {{}, bounce.power, bounce.driven_power};
        const double weight = unshot_weight(bounce, first, run.options.beta);
        bounce.step.rays = bounce.power > 0 ? budget.next(weight) : 0;
        if (bounce.step.rays == 0) break;
        bounce.step.known_light = Light(run.surfaces, solution.irradiance);
        bounce.step.leaves_only = !oracle_refines;
        if (oracle_refines)
            bounce.step.oracle = make_oracle(solution, run.schedule.averaged_rays() + rays, run.floor.unseen());
        bounce.step.spent = std::move(unshot);
        unshot = trace_bounce(run, std::move(bounce.step), fresh, escaped_power);
        if (!driver.elements.empty())
            inherit(*run.forest, static_cast<std::uint32_t>(driver.elements.size()), driver.elements);
    }
    if (fresh.irradiance.empty())  // nothing could be shot
        fresh = {std::vector<Rgb>(run.forest->size(), Rgb(0)), std::vector<float>(run.forest->size(), 0.0f)};
    state.bounces = budget.bounces();
    state.unshot = std::move(unshot);
    state.unshot_rays = static_cast<double>(rays);
    if (!oracle_refines) pull(*run.forest, fresh.irradiance), pull_variance(*run.forest, fresh.variance);
    return fresh;
}

PassState prepare_passes(Run& run) {
    PassState state;
    if (run.options.rays < fewest_rays_with_preparation) return state;
    const std::int64_t rays = run.schedule.start_rays();
    if (importance_use(run.solution) == ImportanceUse::full) start_importance(run, rays);
    RgbD escaped_power(0, 0, 0);
    if (run.options.method.refines) {
        run.solution.irradiance = trace_pass(run, state, rays, false, escaped_power).irradiance;
        PassState refined;
        refined.bounces = state.bounces;
        run.solution.irradiance = trace_pass(run, refined, rays, true, escaped_power).irradiance;
        state.bounces = refined.bounces;
    }
    state.unshot.clear();
    const std::int64_t traced = run.power_rays + run.importance_rays;
    run.schedule.began_with(0, traced);
    if (traced > 0) report(run, 0, escaped_power);
    return state;
}

void make_first_estimate(Run& run) {
    PassState state = prepare_passes(run);
    state.is_final = true;
    if (run.power_rays == 0) {
        RgbD escaped_power(0, 0, 0);
        run.solution.irradiance = trace_pass(run, state, run.schedule.start_rays(), false, escaped_power).irradiance;
        run.schedule.began_with(0, run.power_rays + run.importance_rays);
        report(run, 0, escaped_power);
    }
}

RgbD iterate_pass(Run& run, PassState& state, IterationPlan& plan) {
    RgbD escaped_power(0, 0, 0);
    const std::int64_t rays_before = run.power_rays + run.importance_rays;
    const bool has_importance_step =
        importance_use(run.solution) == ImportanceUse::full && run.options.separate_iterations;
    const std::int64_t for_importance =
        has_importance_step ? std::llround(run.options.alpha * static_cast<double>(plan.rays)) : 0;
    if (for_importance > 0) {
        const Importance psi = importance_of(run.solution);
        const Received received = run_step(run, importance_step(run.surfaces, run.solution, psi, for_importance));
        merge(run, run.solution.indirect_importance, received.importance, plan);
        run.importance_rays += for_importance;
    }
    if (plan.rays == for_importance) return escaped_power;
    state.is_final = plan.is_final;
    const bool by_power = run.options.method.refines && !refines_by_variance(run.options);
    const std::uint32_t before = run.forest->size();
    const FreshEstimate fresh = trace_pass(run, state, plan.rays - for_importance, by_power, escaped_power);
    plan.rays = std::max<std::int64_t>(1, run.power_rays + run.importance_rays - rays_before);
    estimate_noise(run, fresh, plan.rays);
    merge_details(run, run.solution.irradiance, fresh.irradiance, plan);
    remember(run, plan, before);
    if (run.options.method.refines && !by_power && run.noise.is_known()) {
        const std::uint32_t size = run.forest->size();
        refine_by_variance(run);
        inherit(*run.forest, size, state.unshot);
    }
    return escaped_power;
}

}  // namespace interflect
