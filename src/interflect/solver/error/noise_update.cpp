#include "interflect/solver/error/noise_update.h"

#include <algorithm>
#include <array>

#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/error/pixel_filter.h"
#include "interflect/solver/shrinkage/sibling_variation.h"

namespace interflect::detail {

namespace {

/// Returns the mean over siblings of y z, the product of their differences in the running mean and in the new estimate
/// (docs/method/method.md, Errors). Subtracts the noise of rays that are part of both.
double measured_signal(const LightState& light, const Estimate& fresh, ElementIndex first) {
    const ElementForest& forest = *light.forest;
    const ElementIndex parent = forest.parent(first);
    const auto difference = [&](const std::vector<Rgb>& irradiance, ElementIndex e) {
        return luminance(irradiance[e]) - luminance(irradiance[parent]);
    };
    double product = 0, area = 0;
    for (ElementIndex e = first; e < first + 4; ++e) {
        product += static_cast<double>(forest.area(e) * difference(light.solution.irradiance, e) *
                                       difference(fresh.irradiance, e));
        if (!fresh.shared_variance.empty())
            product -=
                static_cast<double>(forest.area(e) * light.noise.variance_of_part(forest, light.solution.irradiance, e,
                                                                                  fresh.shared_variance[e]));
        area += forest.area(e);
    }
    return product / area;
}

/// Compares the predicted errors after shrinkage with errors measured by the new estimate.
RiskCheck check_risk(const SolverState& state, const Estimate& fresh) {
    const ElementForest& forest = *state.light.forest;
    const std::uint32_t roots = forest.patch_count();
    const ErrorMeasure measure = default_measure(state.light);
    const auto check_siblings = [&](ElementIndex first, RiskCheck& sum) {
        const ElementIndex parent = forest.parent(first);
        const double w = error_weight(state.inputs, state.light, measure, parent) * forest.area(parent);
        if (!(w > 0)) return;
        const SiblingVariation variation = sibling_variation(state.light, first);
        if (!variation.is_known()) return;

        // Compare the squared errors of the four siblings
        const double signal = measured_signal(state.light, fresh, first), k = variation.shrinkage();
        const double shown = shown_of_siblings(state.inputs, state.light, measure, first);
        const AddedError expected = added_error(state.light, first, variation);
        sum.measured += w * shown * (k * k * variation.spread + (1 - 2 * k) * signal);
        sum.expected += w * shown * static_cast<double>(expected.noise + expected.bias);

        // Sum the signals of leaves, from which those of finer levels are extrapolated
        const double of_parent =
            parent < roots ? 0 : measured_signal(state.light, fresh, first_sibling(forest, parent));
        for (ElementIndex e = first; e < first + 4; ++e) {
            if (!forest.is_leaf(e)) continue;
            const double of_leaf = error_weight(state.inputs, state.light, measure, e) * forest.area(e);
            const std::array<float, finer_levels> shown_of_level = shown_within(state.inputs, state.light, measure, e);
            sum.signal += of_leaf * signal;
            sum.signal_of_parents += of_leaf * of_parent;
            for (std::size_t level = 0; level < finer_levels; ++level)
                sum.within[level] += of_leaf * shown_of_level[level] * signal;
        }
    };
    const auto check = [&](std::size_t begin, std::size_t end) {
        RiskCheck part;
        for (std::size_t i = begin; i < end; ++i) check_siblings(ElementIndex(roots + 4 * i), part);
        return part;
    };
    RiskCheck sum =
        parallel_sum(state.work.stop.ranks(), (forest.size() - roots) / 4, elements_per_task, RiskCheck(), check);
    sum.weight = 1;
    return sum;
}

}  // namespace

void estimate_noise(SolverState& state, const Estimate& fresh, std::int64_t rays) {
    const ErrorMeasure measure = default_measure(state.light);
    const auto weight = [&](ElementIndex e) {
        return error_weight(state.inputs, state.light, measure, e) * state.light.forest->area(e);
    };
    if (uses_shrinkage(state.light) && state.light.noise.is_known()) {
        constexpr double long_enough = 0.25;  // share of the averaged rays at which an iteration has full weight
        const double before = long_enough * static_cast<double>(state.rays.schedule.averaged_rays());
        state.light.risk_check.add(check_risk(state, fresh),
                                   std::min(1.0, static_cast<double>(rays) / std::max(1.0, before)));
    }
    state.light.noise.add(*state.light.forest, fresh, state.light.solution.irradiance, state.light.history,
                          static_cast<float>(rays), weight);
}

}  // namespace interflect::detail
