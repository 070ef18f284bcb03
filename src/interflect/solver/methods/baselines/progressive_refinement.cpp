#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/iteration/merge.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

namespace {

/// Minimum weight of a patch that shoots in a step, relative to the largest weight.
constexpr float share_of_largest = 0.5f;
/// A step shoots all the rest if the unshot share or the number of rays is below these limits.
constexpr double negligible_rest = 0.01;
constexpr std::int64_t fewest_rays_of_step = 16;
/// Initial value of ShotBudget::expected.
constexpr double assumed_shots = 2;

/// Distributes rays over the steps of a series. Weights are amounts of power or importance, relative to the initial
/// amount.
struct ShotBudget {
    std::int64_t left;  ///< Number of rays of the remaining steps.
    double expected;    ///< Expected sum of the weights of all steps.
    double shot = 0;    ///< Sum of the weights so far.

    double measured() const { return shot > 0 ? shot : expected; }
    /// Returns the number of rays of a step.
    /// @param weight  Amount that the step shoots.
    /// @param unshot  Total unshot amount.
    std::int64_t share(double weight, double unshot) const {
        return std::llround(std::min(1.0, weight / (expected * unshot)) * static_cast<double>(left));
    }
    /// Returns the number of random walks for the remaining rays. A walk has `expected` rays on average.
    std::int64_t walks() const {
        return std::max<std::int64_t>(1, std::llround(static_cast<double>(left) / std::max(1.0, expected)));
    }
    bool is_last(double weight, double unshot) const {
        const std::int64_t next = share(weight, unshot);
        return next < fewest_rays_of_step || left - next < fewest_rays_of_step;
    }
};

/// Sets small weights to 0.
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

template <class T>
void replace_shot(std::vector<T>& unshot, const std::vector<float>& chosen, const std::vector<T>& arrived) {
    for (std::size_t i = 0; i < unshot.size(); ++i) unshot[i] = (chosen[i] > 0 ? T(0) : unshot[i]) + arrived[i];
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

struct ImportanceSeries {
    ShotBudget budget;
    std::vector<float> unshot, fresh;  ///< Unshot importance, and the sum of received importance over the steps.
    double first = 0;
};

struct PowerSeries {
    ShotBudget budget;
    ImportanceWeights weights;
    std::vector<Rgb> unshot;
    Estimate fresh;
    bool emits = true;  ///< Whether the next step is the first, which shoots emitted power.
    double first_power = 0, first_weighted_power = 0;  ///< Powers of the PowerPlan of the first step.
};

/// Shoots importance from the patches that have the most unshot importance. Returns whether another step follows.
bool shoot_some_importance(SolverState& state, ImportanceSeries& series) {
    const ElementForest& forest = *state.light.forest;
    double unshot = 0;
    for (PatchIndex i{0}; i < forest.patch_count(); ++i)
        unshot += static_cast<double>(state.inputs.materials.mean_reflectance(i) * series.unshot[i]) * forest.area(i);
    if (!(unshot > 0)) return false;
    if (series.budget.shot == 0) series.first = unshot;
    unshot /= series.first;
    TransportStep step(plan_importance(state.inputs.materials, state.light.solution, Importance(series.unshot), 0));
    std::vector<float> chosen = step.q;
    choose_largest(chosen);
    double weight = unshot * sum_of(chosen) / sum_of(step.q);
    const bool is_last = unshot < negligible_rest || series.budget.is_last(weight, unshot);
    if (is_last) {
        chosen = step.q;
        weight = unshot;
    }
    step.q = chosen;
    step.rays = is_last ? series.budget.left : series.budget.share(weight, unshot);
    const std::int64_t rays = step.rays;
    const Received received = run_step(state, std::move(step));
    state.rays.importance += rays;
    series.budget.left -= rays;
    series.budget.shot += weight;
    replace_shot(series.unshot, chosen, received.importance);
    for (std::size_t i = 0; i < series.fresh.size(); ++i) series.fresh[i] += received.importance[i];
    return !is_last;
}

bool shoot_some_power(SolverState& state, PowerSeries& series) {
    const Radiosity light(state.inputs.materials, series.unshot, series.emits);
    auto [plan, power, weighted_power, non_finite_leaves] = plan_power(
        state.inputs.materials, state.inputs.emission, state.light.solution, light, series.weights, false, 0);
    if (!(power > 0)) return false;
    TransportStep step(std::move(plan));
    if (series.emits) {
        series.first_power = power;
        series.first_weighted_power = weighted_power;
    }
    // Compute the unshot amount relative to the first step
    const double beta = series.first_weighted_power > 0 ? state.light.options().experimental.beta : 1;
    const double unshot =
        beta * ratio(power, series.first_power) + (1 - beta) * ratio(weighted_power, series.first_weighted_power);
    // Choose all emitters in the first step, then the patches with the most unshot power
    std::vector<float> chosen = step.q;
    if (series.emits)
        for (ElementIndex e{0}; e < state.light.forest->size(); ++e)
            chosen[e] = channel_sum(state.inputs.materials.exitance(state.light.forest->patch(e))) > 0 ? chosen[e] : 0;
    else
        choose_largest(chosen);
    double weight = unshot * sum_of(chosen) / sum_of(step.q);
    // The test uses unweighted power, because unimportant power may reach important patches later.
    const bool is_last = power < negligible_rest * series.first_power || series.budget.is_last(weight, unshot);
    if (is_last) {
        chosen = step.q;
        weight = unshot * series.budget.expected;
    }
    step.q = chosen;
    const std::int64_t rays = is_last ? series.budget.left : series.budget.share(weight, unshot);
    step.completes_by_walks = is_last;
    step.rays = is_last ? series.budget.walks() : rays;
    const Received received = run_step(state, std::move(step));
    state.rays.power += rays;
    state.sampling.payloads += received.payloads;
    state.light.solution.non_finite += non_finite_leaves;
    series.fresh.escaped_power += received.escaped_power;
    series.budget.left -= rays;
    series.budget.shot += weight;
    series.emits = false;
    replace_shot(series.unshot, chosen, received.irradiance);
    for (std::size_t i = 0; i < series.unshot.size(); ++i) {
        series.fresh.irradiance[i] += received.irradiance[i];
        series.fresh.variance[i] += received.variance[i];
    }
    return !is_last;
}

/// Progressive refinement (Cohen et al. 1988; Bekaert and Willems 1994, 1995; docs/method/method.md).
class ProgressiveRefinement final : public IterationMethod {
  public:
    void prepare(SolverState& state) override {
        current_.importance_history = 0;
        shoot_importance(state, std::min(state.rays.schedule.start_rays(),
                                         missing_importance_rays(state, state.light.options().limits.rays)));
        state.rays.schedule.record_start(0, state.rays.importance);
    }
    void update_importance(SolverState& state, TracedIteration& iteration) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void discard() override { current_ = before_; }
    void change_views(SolverState& state) override;
    void archive(StateArchive& archive) override;

  private:
    std::int64_t missing_importance_rays(const SolverState& state, std::int64_t planned) const;
    void shoot_importance(SolverState& state, std::int64_t rays);

    struct SeriesHistory {
        double importance_shots = assumed_shots, power_shots = assumed_shots;  // values of ShotBudget::expected
        std::int64_t importance_history = 0;                                   // number of rays in the mean importance
    };
    SeriesHistory current_, before_;
};

std::int64_t ProgressiveRefinement::missing_importance_rays(const SolverState& state, std::int64_t planned) const {
    if (importance_use(state.light.solution) != ImportanceUse::full) return 0;
    const std::int64_t share = std::llround(state.light.options().experimental.alpha * static_cast<double>(planned));
    return std::max<std::int64_t>(0, share - current_.importance_history);
}

void ProgressiveRefinement::shoot_importance(SolverState& state, std::int64_t rays) {
    if (rays <= 0) return;
    ImportanceSeries series{{rays, current_.importance_shots}, state.light.solution.view_importance, {}};
    series.fresh.assign(series.unshot.size(), 0.0f);
    while (shoot_some_importance(state, series)) {
    }
    current_.importance_shots = series.budget.measured();
    current_.importance_history += rays;
    const auto tau = static_cast<float>(static_cast<double>(rays) / static_cast<double>(current_.importance_history));
    std::vector<float>& psi = state.light.solution.indirect_importance;
    for (std::size_t i = 0; i < psi.size(); ++i) psi[i] += tau * (series.fresh[i] - psi[i]);
}

void ProgressiveRefinement::update_importance(SolverState& state, TracedIteration& iteration) {
    before_ = current_;
    iteration.importance_rays =
        std::min(iteration.plan.rays, missing_importance_rays(state, state.rays.schedule.rays() + iteration.plan.rays));
    const std::int64_t rays_before = state.rays.importance;
    shoot_importance(state, iteration.importance_rays);
    iteration.rays = state.rays.importance - rays_before;
}

Estimate ProgressiveRefinement::trace(SolverState& state, TracedIteration& iteration) {
    const std::vector<Rgb> dark(state.light.forest->size(), Rgb(0));
    PowerSeries series{{iteration.plan.rays - iteration.importance_rays, current_.power_shots},
                       importance_weights(state.light.solution, state.sampling.neighbourhoods, state.inputs.emission,
                                          state.sampling.part_importance),
                       dark,
                       {dark, std::vector<float>(dark.size(), 0.0f), {}}};
    if (series.budget.left > 0) {
        const std::int64_t rays_before = state.rays.power;
        state.sampling.payloads = {};
        while (shoot_some_power(state, series)) {
        }
        current_.power_shots = series.budget.measured();
        iteration.rays += state.rays.power - rays_before;
    }
    // Rays stay unused if no surface reflects importance or light.
    iteration.rays = std::max<std::int64_t>(1, iteration.rays);
    return std::move(series.fresh);
}

void ProgressiveRefinement::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    TracedIteration of_power = iteration;
    of_power.weight -= iteration.importance_rays;
    if (of_power.weight == 0) return;
    if (!iteration.plan.warms_up) estimate_noise(state, estimate, of_power.weight);
    detail::merge(state.light, state.light.solution.irradiance, estimate.irradiance, of_power);
    merge_escaped_power(state.light, estimate.escaped_power, of_power);
    update_history(state.light, of_power);
}

void ProgressiveRefinement::change_views(SolverState& state) {
    IterationMethod::change_views(state);
    current_.importance_history = 0;
    current_.importance_shots = assumed_shots;
}

void ProgressiveRefinement::archive(StateArchive& archive) {
    archive.amounts("pr/importance_shots", current_.importance_shots);
    archive.amounts("pr/power_shots", current_.power_shots);
    archive("pr/importance_history", current_.importance_history);
}

}  // namespace

std::unique_ptr<IterationMethod> make_progressive_refinement(SolverState&) {
    return std::make_unique<ProgressiveRefinement>();
}

}  // namespace interflect::detail
