#include "interflect/solver/well_distributed.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interflect/solver/steps.h"

namespace interflect {

namespace {

/// What one ray of each leaf carries: one quantum, of the colour of the leaf's light. Its channels sum to 1.
std::vector<Rgb> quanta(const TransportStep& step) {
    std::vector<Rgb> result;
    result.reserve(step.leaves.size());
    for (const std::uint32_t leaf : step.leaves) {
        const Rgb& b = step.radiosity[leaf];
        const float sum = channel_sum(b);
        result.push_back(sum > 0 ? b / sum : Rgb(0));
    }
    return result;
}

}  // namespace

WellDistributedRays::WellDistributedRays(const Run& run)
    : shot_(run.forest->size(), 0.0), arrived_(run.forest->size(), Rgb(0)) {}

RgbD WellDistributedRays::iterate(Run& run, IterationPlan& plan) {
    // power_step's weights are the powers of the leaves here, since these methods know no importance.
    TransportStep step = power_step(run.surfaces, run.solution, present_radiosity(run), false, plan.rays);
    const double all_power = std::accumulate(step.q.begin(), step.q.end(), 0.0);
    double lacking = 0;
    for (std::size_t s = 0; s < step.leaves.size(); ++s) {
        const double share = static_cast<double>(total_ + plan.rays) * step.q[s] / all_power;
        step.q[s] = std::max(0.0, share - shot_[step.leaves[s]]);
        lacking += step.q[s];
    }
    step.rays = std::max<std::int64_t>(1, std::llround(lacking));
    total_ += step.rays;
    step.quanta = quanta(step);
    if (run.options.method.refines) step.oracle = make_oracle(run.solution, step, total_, run.smallest_element);

    std::vector<std::uint64_t> used_before = run.streams.used;
    used_before.resize(run.forest->size(), 0);
    const std::uint32_t elements_before = run.forest->size();
    const Received received = run_step(run, step);
    for (const std::uint32_t leaf : step.leaves)
        shot_[leaf] += static_cast<double>(run.streams.used[leaf] - used_before[leaf]);
    shot_.resize(run.forest->size());
    for (std::uint32_t e = elements_before; e < run.forest->size(); ++e)
        shot_[e] = shot_[run.forest->parent(e)] * run.forest->area(e) / run.forest->area(run.forest->parent(e));
    inherit(*run.forest, elements_before, arrived_);

    const auto power_per_ray = static_cast<float>(all_power / static_cast<double>(total_));
    std::vector<Rgb> fresh(arrived_.size());
    for (std::size_t e = 0; e < arrived_.size(); ++e) {
        fresh[e] = static_cast<float>(all_power / static_cast<double>(step.rays)) * received.irradiance[e];
        arrived_[e] += received.irradiance[e];
    }
    pull(*run.forest, arrived_);
    if (run.schedule.averaged_rays() > 0) estimate_error(run, fresh, step.rays);
    for (std::size_t e = 0; e < arrived_.size(); ++e) run.solution.irradiance[e] = power_per_ray * arrived_[e];
    run.history.assign(run.forest->size(), static_cast<float>(total_));
    run.power_rays += step.rays;
    plan.rays = step.rays;
    escaped_ += received.escaped_power;
    return escaped_ * (all_power / static_cast<double>(total_));
}

}  // namespace interflect
