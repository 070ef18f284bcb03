#include "interflect/solver/methods/baselines/well_distributed.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/refinement/oracle_threshold.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

WellDistributedRays::WellDistributedRays(const SolverState& state)
    : shot_(state.light.forest->size(), 0.0), received_(state.light.forest->size(), Rgb(0)) {}

void WellDistributedRays::prepare(SolverState& state) {
    if (!state.light.options().experimental.one_bounce) passes_.make_first_estimate(state);
    shot_.assign(state.light.forest->size(), 0.0);
    shot_by_parts_.assign(state.inputs.emission.part_count(), 0.0);
    received_.assign(state.light.forest->size(), Rgb(0));
    received_groups_.assign(state.inputs.groups.size(), received_);
}

void WellDistributedRays::archive(StateArchive& archive) {
    passes_.archive(archive);
    archive.amounts("well_distributed/shot", shot_);
    archive.amounts("well_distributed/shot_by_parts", shot_by_parts_);
    archive.amounts("well_distributed/received", received_);
    archive_groups(archive, "well_distributed/groups", received_groups_);
    archive.amounts("well_distributed/escaped", escaped_);
    archive("well_distributed/total", total_);
}

/// Replaces plan.q by the number of missing rays of each source, if all sources together should have `all` rays. If a
/// leaf has shot more than its share, other leaves of its patch shoot less.
void WellDistributedRays::plan_missing_rays(const ElementForest& forest, std::int64_t all, RayPlan& plan) const {
    struct Balance {
        double net = 0;      // missing rays of the patch, reduced by the surplus of some leaves
        double missing = 0;  // sum of the missing rays of its leaves, without surpluses
    };
    std::vector<Balance> patches(forest.patch_count());
    const auto missing = [&](ElementIndex e) { return static_cast<double>(all) * plan.q[e] - shot_[e]; };
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        if (!forest.is_leaf(e)) continue;
        patches[forest.patch(e)].net += missing(e);
        patches[forest.patch(e)].missing += std::max(0.0, missing(e));
    }
    double all_missing = 0;
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        const Balance& patch = patches[forest.patch(e)];
        const bool shoots = forest.is_leaf(e) && patch.net > 0;
        plan.q[e] = shoots ? static_cast<float>(std::max(0.0, missing(e)) * (patch.net / patch.missing)) : 0.0f;
        all_missing += plan.q[e];
    }
    for (std::size_t i = 0; i < plan.part_count(); ++i) {
        float& q = plan.q[forest.size() + i];
        q = static_cast<float>(std::max(0.0, static_cast<double>(all) * q - shot_by_parts_[i]));
        all_missing += q;
    }
    plan.rays = std::max<std::int64_t>(1, std::llround(all_missing));
}

Estimate WellDistributedRays::trace(SolverState& state, TracedIteration& iteration) {
    const ElementForest& forest = *state.light.forest;
    const Radiosity light(state.inputs.materials, state.light.solution.irradiance);
    PowerPlan power = plan_power(state.inputs.materials, state.inputs.emission, state.light.solution, light, {}, false,
                                 iteration.plan.rays);
    TransportStep step(std::move(power.plan));
    step.equal_payloads = true;
    step.groups = group_radiosity(state.inputs, state.light, state.light.solution.groups);
    // Without importance, the probabilities q are shares of all power.
    const double all_power = channel_sum(radiated_power(state.inputs, state.light));
    plan_missing_rays(forest, total_ + iteration.plan.rays, step);
    const std::int64_t rays = iteration.weight = iteration.rays = step.rays;
    if (state.light.options().method.refines)
        step.oracle = make_oracle(state.light.solution, total_ + rays, state.inputs.element_floor.default_min_area());

    // Trace the missing rays, and count the rays of each source
    Counts used_before = state.sampling.streams.used;
    std::vector<std::uint64_t> used_by_parts_before = state.sampling.streams.used_by_parts;
    used_by_parts_before.resize(shot_by_parts_.size(), 0);
    used_before.resize(iteration.plan.old_elements);
    const Received received = run_step(state, std::move(step));
    total_ += rays;
    state.light.solution.non_finite += power.non_finite_leaves;
    for (ElementIndex e{0}; e < iteration.plan.old_elements; ++e)
        shot_[e] += static_cast<double>(state.sampling.streams.used[e] - used_before[e]);
    for (std::size_t i = 0; i < shot_by_parts_.size(); ++i)
        shot_by_parts_[i] += static_cast<double>(state.sampling.streams.used_by_parts[i] - used_by_parts_before[i]);
    shot_.resize(forest.size());
    for (ElementIndex e(iteration.plan.old_elements); e < forest.size(); ++e)
        shot_[e] = shot_[forest.parent(e)] * forest.area(e) / forest.area(forest.parent(e));
    inherit(forest, iteration.plan.old_elements, received_);
    inherit(forest, iteration.plan.old_elements, received_groups_);
    // Convert numbers of payloads to irradiance, and add them to the earlier numbers
    const auto payload = static_cast<float>(all_power / static_cast<double>(rays));
    Estimate estimate;
    estimate.irradiance.resize(forest.size());
    estimate.variance.resize(forest.size());
    for (std::size_t e = 0; e < forest.size(); ++e) {
        estimate.irradiance[e] = payload * received.irradiance[e];
        // The square of the payload may be out of range.
        estimate.variance[e] = payload * (payload * received.variance[e]);
        received_[e] += received.irradiance[e];
    }
    pull(forest, received_);
    accumulate(received_groups_, received.groups);
    pull(forest, received_groups_);
    escaped_ += received.escaped_power;
    estimate.shot_power = all_power;
    return estimate;
}

void WellDistributedRays::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    const double power_per_ray = estimate.shot_power / static_cast<double>(total_);
    estimate_noise(state, estimate, iteration.weight);
    for (std::size_t e = 0; e < received_.size(); ++e)
        state.light.solution.irradiance[e] = static_cast<float>(power_per_ray) * received_[e];
    state.light.solution.groups = received_groups_;
    scale(state.light.solution.groups, static_cast<float>(power_per_ray));
    state.light.history.assign(state.light.forest->size(), static_cast<float>(total_));
    state.rays.power += iteration.weight;
    state.light.escaped_power = escaped_ * power_per_ray;
}

std::unique_ptr<IterationMethod> make_well_distributed_rays(SolverState& state) {
    return std::make_unique<WellDistributedRays>(state);
}

}  // namespace interflect::detail
