#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/iteration_method.h"
#include "interflect/solver/merge.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/transport_steps.h"

namespace interflect::inline detail {

namespace {

/// A step shoots all patches whose sampling weight is at least this share of the largest.
constexpr float share_of_largest = 0.5f;
/// The last step shoots the rest: if less than this share of the initial amount is unshot, or if a step would get fewer
/// rays.
constexpr double negligible_rest = 0.01;
constexpr std::int64_t fewest_rays_of_step = 16;
/// Sum of the weights of all steps, until a series of steps has measured it.
constexpr double assumed_shots = 2;

/// Distribution of rays over one series of steps, from darkness until little is left to shoot. Weights are relative to
/// the initially unshot amount.
struct ShotBudget {
    std::int64_t left = 0;            ///< Rays.
    double expected = assumed_shots;  ///< Sum of the weights of all steps.
    double shot = 0;                  ///< Sum of the weights so far.
    bool is_under_way = false;

    void begin(std::int64_t rays) {
        left = rays;
        shot = 0;
        is_under_way = true;
    }
    void end() {
        if (shot > 0) expected = shot;
        is_under_way = false;
    }
    /// @param weight Amount selected for a step.
    /// @param unshot Total unshot amount. Later reflections are expected in proportion to it.
    std::int64_t share(double weight, double unshot) const {
        return std::llround(std::min(1.0, weight / (expected * unshot)) * static_cast<double>(left));
    }
    /// Returns the number of random walks for the remaining rays: a walk shoots its power `expected` times.
    std::int64_t walks() const {
        return std::max<std::int64_t>(1, std::llround(static_cast<double>(left) / std::max(1.0, expected)));
    }
    bool is_last(double weight, double unshot) const {
        const std::int64_t next = share(weight, unshot);
        return next < fewest_rays_of_step || left - next < fewest_rays_of_step;
    }
    void archive(StateArchive& archive, const std::string& name) {
        archive(name + "/left", left);
        archive(name + "/expected", expected);
        archive(name + "/shot", shot);
        archive(name + "/is_under_way", is_under_way);
    }
};

/// Keeps the sampling weights that are at least share_of_largest times the largest; sets the others to 0.
void choose_largest(std::vector<float>& q) {
    const float least = share_of_largest * *std::max_element(q.begin(), q.end());
    for (float& weight : q)
        if (weight < least) weight = 0;
}

double sum_of(const std::vector<float>& q) {
    double sum = 0;
    for (const float weight : q) sum += weight;
    return sum;
}

/// Removes the amounts that were shot and adds the received ones.
template <class T>
void replace_shot(std::vector<T>& unshot, const std::vector<float>& chosen, const std::vector<T>& arrived) {
    for (std::size_t i = 0; i < unshot.size(); ++i) unshot[i] = (chosen[i] > 0 ? T(0) : unshot[i]) + arrived[i];
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

/// Progressive refinement (Cohen et al. 1988; Bekaert and Willems 1994, 1995) with rays in place of form factors, see
/// docs/method.md. Each step shoots the patches with the most unshot power, weighted by importance if there is a view.
/// The first step shoots the emitters. Importance is computed by the same steps in dual order. A step is a batch of all
/// patches with at least half of the largest amount, so transport() traces long batches.
///
/// An iteration is a solution from darkness. Random walks complete its last step of power, and carry most of the power
/// if rays are few. Constant on patches: no refinement. The same seed gives the same bits for any number of threads.
class ProgressiveRefinement final : public IterationMethod {
  public:
    /// Computes importance, which guides the first power rays.
    void prepare(SolverState& state) override {
        shoot_importance(state,
                         std::min(state.schedule.start_rays(), lacking_importance(state, state.options.limits.rays)));
        state.schedule.began_with(0, state.importance_rays);
    }
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    void retarget(SolverState& state) override;
    void archive(StateArchive& archive) override;
    bool fits(const SolverState& state) const override;

  private:
    std::int64_t lacking_importance(const SolverState& state, std::int64_t planned) const;
    void shoot_importance(SolverState& state, std::int64_t rays);
    bool shoot_some_importance(SolverState& state);
    void begin_power(SolverState& state, std::int64_t rays);
    bool shoot_some_power(SolverState& state);
    void shoot_power(SolverState& state, IterationPlan plan);

    ShotBudget importance_budget_, power_budget_;
    std::vector<float> unshot_importance_, fresh_importance_;  // the latter summed over all steps so far
    double first_importance_ = 0;                              // unshot before the first step
    std::int64_t importance_history_ = 0;                      // number of rays in the mean
    bool emits_ = true;                                        // whether the next step of power is the first
    std::vector<Rgb> unshot_;                                  // irradiance
    FreshEstimate fresh_;                                      // sum of all steps so far
    ImportanceWeights weights_;
    double first_power_ = 0, first_weighted_power_ = 0;  // see PowerStep; before the first step
    std::int64_t power_rays_ = 0;                        // of the current or last series
    RgbD escaped_{0, 0, 0};                              // power, of the same series
    std::int64_t for_importance_ = -1;                   // rays of this iteration; -1: not begun
    std::int64_t rays_before_ = 0;                       // at the start of the iteration
};

/// Returns the number of rays that importance lacks of its share alpha of `planned` rays in total.
std::int64_t ProgressiveRefinement::lacking_importance(const SolverState& state, std::int64_t planned) const {
    if (importance_use(state.solution) != ImportanceUse::full) return 0;
    const std::int64_t share = std::llround(state.options.experimental.alpha * static_cast<double>(planned));
    return std::max<std::int64_t>(0, share - importance_history_);
}

/// Performs one step. @return Whether another follows.
bool ProgressiveRefinement::shoot_some_importance(SolverState& state) {
    const ElementForest& forest = *state.forest;
    double unshot = 0;
    for (std::uint32_t i = 0; i < forest.patch_count(); ++i)
        unshot += static_cast<double>(state.materials.mean_reflectance(i) * unshot_importance_[i]) * forest.area(i);
    if (!(unshot > 0)) return false;
    if (importance_budget_.shot == 0) first_importance_ = unshot;
    unshot /= first_importance_;
    TransportStep step = importance_step(state.materials, state.solution, Importance(unshot_importance_), 0);
    std::vector<float> chosen = step.q;
    choose_largest(chosen);
    double weight = unshot * sum_of(chosen) / sum_of(step.q);
    const bool is_last = unshot < negligible_rest || importance_budget_.is_last(weight, unshot);
    if (is_last) chosen = step.q, weight = unshot;
    step.q = chosen;
    step.rays = is_last ? importance_budget_.left : importance_budget_.share(weight, unshot);
    const std::int64_t rays = step.rays;
    const Received received = run_step(state, std::move(step));
    state.importance_rays += rays;
    importance_budget_.left -= rays;
    importance_budget_.shot += weight;
    replace_shot(unshot_importance_, chosen, received.importance);
    for (std::size_t i = 0; i < fresh_importance_.size(); ++i) fresh_importance_[i] += received.importance[i];
    return !is_last;
}

/// Transports importance from the views and merges the result with the mean.
void ProgressiveRefinement::shoot_importance(SolverState& state, std::int64_t rays) {
    if (rays <= 0) return;
    if (!importance_budget_.is_under_way) {
        importance_budget_.begin(rays);
        unshot_importance_ = state.solution.view_importance;
        fresh_importance_.assign(unshot_importance_.size(), 0.0f);
    }
    while (shoot_some_importance(state)) {
    }
    importance_budget_.end();
    importance_history_ += rays;
    const auto tau = static_cast<float>(static_cast<double>(rays) / static_cast<double>(importance_history_));
    std::vector<float>& psi = state.solution.indirect_importance;
    for (std::size_t i = 0; i < psi.size(); ++i) psi[i] += tau * (fresh_importance_[i] - psi[i]);
}

void ProgressiveRefinement::begin_power(SolverState& state, std::int64_t rays) {
    power_budget_.begin(rays);
    emits_ = true;
    weights_ = importance_weights(state.solution, state.neighbourhoods, state.emission, state.part_importance);
    const std::size_t elements = state.forest->size();
    unshot_.assign(elements, Rgb(0));
    fresh_ = {std::vector<Rgb>(elements, Rgb(0)), std::vector<float>(elements, 0.0f), {}};
    power_rays_ = rays;
    escaped_ = RgbD(0, 0, 0);
    state.quanta = {};
}

/// Performs one step. @return Whether another follows.
bool ProgressiveRefinement::shoot_some_power(SolverState& state) {
    const Radiosity light(state.materials, unshot_, emits_);
    auto [step, power, weighted_power, lost] =
        power_step(state.materials, state.emission, state.solution, light, weights_, false, 0);
    if (!(power > 0)) return false;
    if (emits_) first_power_ = power, first_weighted_power_ = weighted_power;
    const double beta = first_weighted_power_ > 0 ? state.options.experimental.beta : 1;
    const double unshot = beta * ratio(power, first_power_) + (1 - beta) * ratio(weighted_power, first_weighted_power_);
    std::vector<float> chosen = step.q;
    if (emits_)  // all emitters, and all parts of the luminaires
        for (std::uint32_t i = 0; i < state.forest->size(); ++i)
            chosen[i] = channel_sum(state.materials.exitance(i)) > 0 ? chosen[i] : 0;
    else
        choose_largest(chosen);
    double weight = unshot * sum_of(chosen) / sum_of(step.q);
    // Unweighted power: unimportant power may reach important patches when it is shot.
    const bool is_last = power < negligible_rest * first_power_ || power_budget_.is_last(weight, unshot);
    if (is_last) chosen = step.q, weight = unshot * power_budget_.expected;
    step.q = chosen;
    const std::int64_t rays = is_last ? power_budget_.left : power_budget_.share(weight, unshot);
    step.to_the_end = is_last;
    step.rays = is_last ? power_budget_.walks() : rays;
    const Received received = run_step(state, std::move(step));
    state.power_rays += rays;
    state.quanta += received.quanta;
    state.solution.non_finite += lost;
    escaped_ += received.escaped_power;
    power_budget_.left -= rays;
    power_budget_.shot += weight;
    emits_ = false;
    replace_shot(unshot_, chosen, received.irradiance);
    for (std::size_t i = 0; i < unshot_.size(); ++i) {
        fresh_.irradiance[i] += received.irradiance[i];
        fresh_.variance[i] += received.variance[i];
    }
    return !is_last;
}

void ProgressiveRefinement::shoot_power(SolverState& state, IterationPlan plan) {
    while (shoot_some_power(state)) {
    }
    power_budget_.end();
    plan.rays = power_rays_;
    if (!plan.warms_up) estimate_noise(state, fresh_, plan.rays);
    merge(state, state.solution.irradiance, fresh_.irradiance, plan);
    merge_escaped_power(state, escaped_, plan);
    update_history(state, plan, state.forest->size());
}

RgbD ProgressiveRefinement::iterate(SolverState& state, IterationPlan& plan) {
    if (for_importance_ < 0) {
        rays_before_ = state.power_rays + state.importance_rays;
        for_importance_ = std::min(plan.rays, lacking_importance(state, state.schedule.rays() + plan.rays));
    }
    if (!power_budget_.is_under_way) {
        shoot_importance(state, for_importance_);
        if (plan.rays > for_importance_) begin_power(state, plan.rays - for_importance_);
    }
    if (power_budget_.is_under_way) shoot_power(state, plan);
    for_importance_ = -1;
    // Rays stay unused if no surface reflects the importance or the light.
    plan.rays = std::max<std::int64_t>(1, state.power_rays + state.importance_rays - rays_before_);
    return state.escaped_power;
}

void ProgressiveRefinement::retarget(SolverState& state) {
    IterationMethod::retarget(state);
    importance_history_ = 0;
    importance_budget_ = {};
    if (power_budget_.is_under_way)
        weights_ = importance_weights(state.solution, state.neighbourhoods, state.emission, state.part_importance);
}

void ProgressiveRefinement::archive(StateArchive& archive) {
    importance_budget_.archive(archive, "pr/importance_budget");
    archive("pr/unshot_importance", unshot_importance_);
    archive("pr/fresh_importance", fresh_importance_);
    archive("pr/first_importance", first_importance_);
    archive("pr/importance_history", importance_history_);
    power_budget_.archive(archive, "pr/power_budget");
    archive("pr/emits", emits_);
    archive("pr/unshot", unshot_);
    archive("pr/irradiance", fresh_.irradiance);
    archive("pr/variance", fresh_.variance);
    archive("pr/weights", weights_.elements);
    archive("pr/nearby", weights_.nearby);
    archive("pr/parts", weights_.parts);
    archive("pr/parts_nearby", weights_.parts_nearby);
    archive("pr/first_power", first_power_);
    archive("pr/first_weighted_power", first_weighted_power_);
    archive("pr/power_rays", power_rays_);
    archive("pr/escaped", escaped_);
    archive("pr/for_importance", for_importance_);
    archive("pr/rays_before", rays_before_);
}

bool ProgressiveRefinement::fits(const SolverState& state) const {
    const ElementForest& forest = *state.forest;
    const auto is_whole = [&](const auto& numbers) { return numbers.empty() || numbers.size() == forest.size(); };
    const auto has_all_parts = [&](const auto& parts) {
        return parts.empty() || parts.size() == state.emission.part_count();
    };
    return is_whole(unshot_importance_) && fresh_importance_.size() == unshot_importance_.size() && is_whole(unshot_) &&
           is_whole(fresh_.irradiance) && fresh_.variance.size() == fresh_.irradiance.size() &&
           is_whole(weights_.elements) && is_whole(weights_.nearby) && has_all_parts(weights_.parts) &&
           has_all_parts(weights_.parts_nearby) && (!power_budget_.is_under_way || unshot_.size() == forest.size());
}

}  // namespace

std::unique_ptr<IterationMethod> make_progressive_refinement(SolverState&) {
    return std::make_unique<ProgressiveRefinement>();
}

}  // namespace interflect::inline detail
