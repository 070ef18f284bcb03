#include "interflect/solver/methods/view_change.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "interflect/elements/forest.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

namespace {

std::vector<float> power_sampling(const SolverState& state) {
    const Radiosity light(state.materials, state.solution.irradiance);
    const ImportanceWeights weights =
        importance_weights(state.solution, state.neighbourhoods, state.emission, state.part_importance);
    std::vector<float> q = plan_power(state.materials, state.emission, state.solution, light, weights, false, 0).plan.q;
    q.resize(state.forest->size());
    return q;
}

std::vector<float> patch_importance(const SolverState& state) {
    const Importance psi = importance_of(state.solution);
    std::vector<float> values;
    for (std::uint32_t i = 0; i < state.forest->patch_count(); ++i) values.push_back(psi[i]);
    return values;
}

/// Returns new over old variance per ray, weighted by importance. Payloads are proportional to power over q.
/// @param importance  By patch.
float noise_ratio(const SolverState& state, const std::vector<float>& importance, const std::vector<float>& old_q,
                  const std::vector<float>& new_q) {
    constexpr double largest = 256;
    const ElementForest& forest = *state.forest;
    const Radiosity light(state.materials, state.solution.irradiance);
    double before = 0, now = 0;
    for (std::uint32_t e = 0; e < forest.size(); ++e) {
        if (!forest.is_leaf(e) || !(old_q[e] > 0) || !(new_q[e] > 0)) continue;
        const double power = static_cast<double>(channel_sum(light.of(forest, e))) * forest.area(e);
        const double weighted_power = power * importance[forest.patch(e)];
        before += weighted_power * power / old_q[e];
        now += weighted_power * power / new_q[e];
    }
    return before > 0 ? static_cast<float>(std::clamp(now / before, 1 / largest, largest)) : 1.0f;
}

}  // namespace

void ViewChange::record(const SolverState& state) {
    old_q_ = power_sampling(state);
    old_importance_ = patch_importance(state);
}

std::vector<float> ViewChange::history_factor(const SolverState& state) const {
    std::vector<float> old_q = old_q_;
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

void ViewChange::archive(StateArchive& archive) {
    archive("passes/old_q", old_q_);
    archive("passes/old_importance", old_importance_);
}

bool ViewChange::fits(const SolverState& state) const {
    const std::uint32_t patches = state.forest->patch_count();
    return old_q_.empty() ||
           (old_q_.size() >= patches && old_q_.size() <= state.forest->size() && old_importance_.size() == patches);
}

void scale_history(SolverState& state, const std::vector<float>& factor) {
    if (factor.empty()) return;
    for (std::uint32_t e = 0; e < state.history.size(); ++e) state.history[e] *= factor[state.forest->patch(e)];
    state.noise.scale_by_patch(*state.forest, factor);
}

}  // namespace interflect::detail
