#include "interflect/solver/iteration/report.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "interflect/base/sums/rank_sums.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/error_estimate.h"

namespace interflect::detail {

namespace {

/// Returns the fraction of the run that is done: the largest fraction of the limits of rays, time and error.
double fraction_done(const Limits& limits, const IterationReport& report) {
    double fraction = static_cast<double>(report.rays) / static_cast<double>(limits.rays);
    fraction = std::max(fraction, report.seconds / limits.time);
    if (limits.until > 0) fraction = std::max(fraction, std::pow(limits.until / report.error_estimate, 2));
    return std::clamp(fraction, 0.0, 1.0);
}

void append_traffic(Work& work, Solution& solution, int iteration) {
    Ranks* const ranks = work.monitor.ranks;
    if (!ranks) return;
    const Ranks::Traffic so_far = ranks->traffic(), before = std::exchange(work.reported_traffic, so_far);
    const Ranks::Traffic own{so_far.bytes - before.bytes, so_far.seconds - before.seconds};
    solution.traffic.push_back({iteration, gather_over_ranks<Ranks::Traffic>(*ranks, std::span(&own, 1))});
}

}  // namespace

void append_report(SolverState& state, int iteration) {
    IterationReport r;
    r.iteration = iteration;
    r.seconds = state.work.seconds();
    r.rays = state.rays.schedule.rays();
    r.power_rays = state.rays.power;
    r.importance_rays = state.rays.importance;
    r.escaped_rays = state.rays.escaped;
    r.elements = state.light.forest->size();
    r.leaves = state.light.forest->patch_count() + (r.elements - state.light.forest->patch_count()) / 4 * 3;
    r.total_power = radiated_power(state.inputs, state.light);
    r.escaped_power = state.light.escaped_power;
    const ErrorEstimate error = estimate_error(state);
    r.error_estimate = error.total();
    r.noise_estimate = error.noise;
    r.discretisation_estimate = error.discretisation;
    constexpr double share_with_more = 0.001;  // share of the rays with a higher payload
    r.largest_payload = state.sampling.payloads.largest_over_mean();
    r.high_payload = state.sampling.payloads.quantile_over_mean(share_with_more);
    r.discarded_hits = state.light.discarded_hits;
    state.light.solution.iterations.push_back(r);
    append_traffic(state.work, state.light.solution, iteration);
    if (state.work.monitor.on_progress)
        state.work.monitor.on_progress({.rays = r.rays,
                                        .fraction = fraction_done(state.light.options().limits, r),
                                        .relative_error = r.error_estimate,
                                        .iteration = &state.light.solution.iterations.back()});
}

}  // namespace interflect::detail
