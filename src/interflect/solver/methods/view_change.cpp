#include "interflect/solver/methods/view_change.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "interflect/elements/forest.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

namespace {

std::vector<float> patch_importance(const LightState& light) {
    const Importance psi = importance_of(light.solution);
    std::vector<float> values;
    for (PatchIndex i{0}; i < light.forest->patch_count(); ++i) values.push_back(psi[i]);
    return values;
}

/// Variance per ray of the old and the new sampling, weighted by importance. The payload of a ray is proportional to
/// the power of its source over its probability q.
struct Noise {
    double before = 0, now = 0;

    float ratio() const {
        constexpr double largest = 256;
        return before > 0 ? static_cast<float>(std::clamp(now / before, 1 / largest, largest)) : 1.0f;
    }
};

/// Computes the noise of rays from leaves. @param importance  One value per patch.
Noise noise_of_leaves(const RunInputs& inputs, const LightState& light, const std::vector<float>& importance,
                      const std::vector<float>& old_q, const std::vector<float>& new_q) {
    const ElementForest& forest = *light.forest;
    const Radiosity radiosity(inputs.materials, light.solution.irradiance);
    Noise noise;
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        if (!forest.is_leaf(e) || !(old_q[e] > 0) || !(new_q[e] > 0)) continue;
        const double power = static_cast<double>(channel_sum(radiosity.of(forest, e))) * forest.area(e);
        const double weighted_power = power * importance[forest.patch(e)];
        noise.before += weighted_power * power / old_q[e];
        noise.now += weighted_power * power / new_q[e];
    }
    return noise;
}

/// Returns the noise of outdoor light for one sampling.
double noise_of_lines(const Emission& emission, const std::vector<float>& part_q, std::span<const OutdoorLine> lines) {
    double noise = 0;
    for (const OutdoorLine& line : lines)
        for (const Emission::PartAlong& along : emission.parts_along(line.light, line.sun)) {
            const double power = channel_sum(emission.power(along.part)), weighted = line.importance * along.brightness;
            if (power > 0 && weighted > 0) noise += weighted * power / static_cast<double>(part_q[along.part]);
        }
    return noise;
}

}  // namespace

ViewChange::Sampling ViewChange::sampling_of(const SolverState& state) {
    const Radiosity light(state.inputs.materials, state.light.solution.irradiance);
    const ImportanceWeights weights = importance_weights(state.light.solution, state.sampling.neighbourhoods,
                                                         state.inputs.emission, state.sampling.part_importance);
    Sampling sampling{
        plan_power(state.inputs.materials, state.inputs.emission, state.light.solution, light, weights, false, 0)
            .plan.q,
        {},
        state.inputs.targets};
    const auto parts = sampling.q.begin() + state.light.forest->size();
    sampling.part_q.assign(parts, sampling.q.end());
    sampling.q.erase(parts, sampling.q.end());
    return sampling;
}

void ViewChange::record(const SolverState& state) {
    old_ = sampling_of(state);
    old_importance_ = patch_importance(state.light);
}

std::vector<float> ViewChange::history_factor(const SolverState& state,
                                              std::span<const OutdoorLine> outdoor_light) const {
    std::vector<float> old_q = old_.q;
    for (ElementIndex e(old_q.size()); e < state.light.forest->size(); ++e)
        old_q.push_back(old_q[state.light.forest->parent(e)] / 4);  // elements created since then
    const Sampling now = sampling_of(state);
    const std::vector<float> new_psi = patch_importance(state.light);
    Noise of_new_views = noise_of_leaves(state.inputs, state.light, new_psi, old_q, now.q);
    const Emission old_emission(*state.inputs.lit, old_.targets);
    if (old_.part_q.size() == old_emission.part_count()) {
        of_new_views.before += noise_of_lines(old_emission, old_.part_q, outdoor_light);
        of_new_views.now += noise_of_lines(state.inputs.emission, now.part_q, outdoor_light);
    }
    const float new_views_ratio = of_new_views.ratio();
    const float old_views_ratio = noise_of_leaves(state.inputs, state.light, old_importance_, old_q, now.q).ratio();
    std::vector<float> ratio(state.light.forest->patch_count());
    for (std::uint32_t i = 0; i < ratio.size(); ++i) {
        const float both = new_psi[i] + old_importance_[i], share = both > 0 ? new_psi[i] / both : 0.5f;
        ratio[i] = std::exp(share * std::log(new_views_ratio) + (1 - share) * std::log(old_views_ratio));
    }
    return ratio;
}

void ViewChange::archive(StateArchive& archive) {
    archive.unchecked("passes/old_q", old_.q);  // not finite if no surface was important
    archive.unchecked("passes/old_part_q", old_.part_q);
    archive("passes/old_targets", old_.targets);
    for (const Imath::Box3f& target : old_.targets)
        StateArchive::require_range(is_finite(target.min) && is_finite(target.max), "passes/old_targets");
    archive.amounts("passes/old_importance", old_importance_);
}

bool ViewChange::is_consistent(const SolverState& state) const {
    const std::uint32_t patches = state.light.forest->patch_count();
    return old_.q.empty() || (old_.q.size() >= patches && old_.q.size() <= state.light.forest->size() &&
                              old_.targets.size() <= max_targets && old_importance_.size() == patches);
}

void scale_history(LightState& light, const std::vector<float>& factor) {
    if (factor.empty()) return;
    light.history.change([&](ElementIndex e, float rays) { return rays * factor[light.forest->patch(e)]; });
    light.noise.scale_by_patch(*light.forest, factor);
}

}  // namespace interflect::detail
