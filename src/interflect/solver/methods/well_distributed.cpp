#include "interflect/solver/methods/well_distributed.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/transport_steps.h"

namespace interflect::inline detail {

WellDistributedRays::WellDistributedRays(const SolverState& state)
    : shot_(state.forest->size(), 0.0), arrived_(state.forest->size(), Rgb(0)) {}

void WellDistributedRays::prepare(SolverState& state) {
    if (!state.options.experimental.one_bounce) passes_.make_first_estimate(state);
    shot_.assign(state.forest->size(), 0.0);
    shot_by_parts_.assign(state.emission.part_count(), 0.0);
    arrived_.assign(state.forest->size(), Rgb(0));
    arrived_groups_.assign(state.groups.size(), arrived_);
}

void WellDistributedRays::archive(StateArchive& archive) {
    passes_.archive(archive);
    archive("well_distributed/shot", shot_);
    archive("well_distributed/shot_by_parts", shot_by_parts_);
    archive("well_distributed/arrived", arrived_);
    archive_groups(archive, "well_distributed/groups", arrived_groups_);
    archive("well_distributed/escaped", escaped_);
    archive("well_distributed/total", total_);
}

/// Sets the weights of the step to the rays that each source lacks of its share of `all` rays. A leaf may have shot
/// more than its share, by chance or because of a poor early estimate. Other leaves of its patch then shoot less, so
/// the patch keeps its share.
/// @param step Its weights are the shares on entry.
void WellDistributedRays::keep_lacking_rays(const ElementForest& forest, std::int64_t all, TransportStep& step) const {
    struct Balance {
        double lacks = 0, lacking = 0;  // missing rays, with and without the surplus of other leaves
    };
    std::vector<Balance> patches(forest.patch_count());
    const auto lacks = [&](std::uint32_t e) { return static_cast<double>(all) * step.q[e] - shot_[e]; };
    for (std::uint32_t e = 0; e < forest.size(); ++e) {
        if (!forest.is_leaf(e)) continue;
        patches[forest.patch(e)].lacks += lacks(e);
        patches[forest.patch(e)].lacking += std::max(0.0, lacks(e));
    }
    double lacking = 0;
    for (std::uint32_t e = 0; e < forest.size(); ++e) {
        const Balance& patch = patches[forest.patch(e)];
        const bool shoots = forest.is_leaf(e) && patch.lacks > 0;
        step.q[e] = shoots ? static_cast<float>(std::max(0.0, lacks(e)) * (patch.lacks / patch.lacking)) : 0.0f;
        lacking += step.q[e];
    }
    for (std::size_t i = 0; i < step.part_count(); ++i) {
        float& q = step.q[forest.size() + i];
        q = static_cast<float>(std::max(0.0, static_cast<double>(all) * q - shot_by_parts_[i]));
        lacking += q;
    }
    step.rays = std::max<std::int64_t>(1, std::llround(lacking));
}

RgbD WellDistributedRays::iterate(SolverState& state, IterationPlan& plan) {
    const ElementForest& forest = *state.forest;
    const Radiosity light(state.materials, state.solution.irradiance);
    auto [step, power, weighted_power, lost_leaves] =
        power_step(state.materials, state.emission, state.solution, light, {}, false, plan.rays);
    step.equal_quanta = true;
    step.groups = group_radiosity(state, state.solution.groups);
    // These methods have no importance: the weights are the leaves' shares of all power.
    const double all_power = channel_sum(radiated_power(state));
    keep_lacking_rays(forest, total_ + plan.rays, step);
    const std::int64_t rays = step.rays;
    if (state.options.method.refines) step.oracle = make_oracle(state.solution, total_ + rays, state.floor.unseen());

    std::vector<std::uint64_t> used_before = state.streams.used, used_by_parts_before = state.streams.used_by_parts;
    used_by_parts_before.resize(shot_by_parts_.size(), 0);
    const std::uint32_t elements_before = forest.size();
    used_before.resize(elements_before, 0);
    const Received received = run_step(state, std::move(step));
    total_ += rays;
    state.solution.non_finite += lost_leaves;
    for (std::uint32_t e = 0; e < elements_before; ++e)
        shot_[e] += static_cast<double>(state.streams.used[e] - used_before[e]);
    for (std::size_t i = 0; i < shot_by_parts_.size(); ++i)
        shot_by_parts_[i] += static_cast<double>(state.streams.used_by_parts[i] - used_by_parts_before[i]);
    shot_.resize(state.forest->size());
    for (std::uint32_t e = elements_before; e < state.forest->size(); ++e)
        shot_[e] = shot_[state.forest->parent(e)] * state.forest->area(e) / state.forest->area(state.forest->parent(e));
    inherit(*state.forest, elements_before, arrived_);
    inherit(*state.forest, elements_before, arrived_groups_);

    const auto power_per_ray = static_cast<float>(all_power / static_cast<double>(total_));
    const auto quantum = static_cast<float>(all_power / static_cast<double>(rays));
    FreshEstimate fresh{std::vector<Rgb>(arrived_.size()), std::vector<float>(arrived_.size()), {}};
    for (std::size_t e = 0; e < arrived_.size(); ++e) {
        fresh.irradiance[e] = quantum * received.irradiance[e];
        fresh.variance[e] = quantum * (quantum * received.variance[e]);  // the square may be out of range
        arrived_[e] += received.irradiance[e];
    }
    pull(*state.forest, arrived_);
    accumulate(arrived_groups_, received.groups);
    pull(*state.forest, arrived_groups_);
    estimate_noise(state, fresh, rays);
    for (std::size_t e = 0; e < arrived_.size(); ++e) state.solution.irradiance[e] = power_per_ray * arrived_[e];
    state.solution.groups = arrived_groups_;
    scale(state.solution.groups, power_per_ray);
    state.history.assign(state.forest->size(), static_cast<float>(total_));
    state.power_rays += rays;
    plan.rays = rays;
    escaped_ += received.escaped_power;
    return escaped_ * (all_power / static_cast<double>(total_));
}

std::unique_ptr<IterationMethod> make_well_distributed_rays(SolverState& state) {
    return std::make_unique<WellDistributedRays>(state);
}

}  // namespace interflect::inline detail
