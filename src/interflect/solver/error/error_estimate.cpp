#include "interflect/solver/error/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interflect/base/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/pixel_filter.h"
#include "interflect/solver/error/sibling_variation.h"

namespace interflect::detail {

namespace {

/// Bounds of the decay of mean squared differences per level: 1/4 for smooth irradiance, 1/2 at edges.
constexpr double min_decay = 0.25, max_decay = 0.7;

struct ErrorSums {
    double weight = 0, noise = 0, bias = 0;
    double noise_of_patches = 0;
    double assumed = 0;  // for undivided patches

    ErrorSums& operator+=(const ErrorSums& o) {
        weight += o.weight, noise += o.noise, bias += o.bias;
        noise_of_patches += o.noise_of_patches, assumed += o.assumed;
        return *this;
    }
};

ErrorSums sum_errors(const SolverState& state, ErrorMeasure measure, const ElementErrors& errors) {
    const ElementForest& forest = *state.forest;
    return parallel_sum(forest.size(), elements_per_task, ErrorSums(), [&](std::size_t begin, std::size_t end) {
        ErrorSums sums;
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            if (!forest.is_leaf(e)) continue;
            const double w = error_weight(state, measure, e) * forest.area(e);
            if (!(w > 0)) continue;
            sums.weight += w;
            sums.noise += w * errors.noise[e];
            sums.bias += w * errors.bias[e];
            sums.noise_of_patches += w * errors.noise_of_patch[e];
            if (e >= forest.patch_count()) continue;
            const float variation = assumed_variation * luminance(state.solution.irradiance[e]);
            sums.assumed += w * shown_within(state, measure, e)[0] * variation * variation;
        }
        return sums;
    });
}

double error_within_leaves(const RiskCheck& check) {
    if (!(check.weight > 0)) return 0;
    const bool is_known = check.signal > 0 && check.signal_of_parents > 0;
    const double decay =
        is_known ? std::clamp(check.signal / check.signal_of_parents, min_decay, max_decay) : min_decay;
    double sum = 0, of_level = 1;
    for (const double within : check.within) sum += std::max(0.0, within) * (of_level *= decay);
    return sum / check.weight;
}

/// Measured if the bias is strongly negative (docs/method.md, Errors).
double error_of_variations(const RiskCheck& check, double noise, double bias) {
    const double expected = noise + bias;
    const bool is_reliable = bias > -noise / 2;
    return is_reliable || !(check.weight > 0) ? check.factor() * expected
                                              : std::max(0.0, check.measured / check.weight);
}

}  // namespace

ElementErrors element_errors(const SolverState& state, ErrorMeasure measure) {
    const ElementForest& forest = *state.forest;
    ElementErrors errors;
    errors.noise.assign(forest.size(), 0);
    errors.bias.assign(forest.size(), 0);
    parallel_for_ranges(forest.patch_count(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (auto root = static_cast<std::uint32_t>(begin); root < end; ++root) {
            const float shown = shown_of_patch(state, measure, root);
            const float rays = std::max(state.history[root], 1.0f);
            errors.noise[root] = shown * state.noise.variance(forest, state.solution.irradiance, root, rays);
        }
    });
    errors.noise_of_patch = errors.noise;
    forest.for_siblings_from_roots([&](std::uint32_t first) {
        const SiblingVariation variation = sibling_variation(state, first);
        const auto [noise, bias] = added_error(state, first, variation);
        const std::uint32_t parent = forest.parent(first);
        const float shown = shown_of_siblings(state, measure, first);
        const Shrinkage shrinkage = shrinkage_of(state, first, variation);
        for (std::uint32_t e = first; e < first + 4; ++e) {
            const float share = shrinkage.noise[e - first];
            errors.noise[e] = share * (errors.noise[parent] + shown * noise);
            errors.noise_of_patch[e] = share * errors.noise_of_patch[parent];
            errors.bias[e] = errors.bias[parent] + shown * bias;
        }
    });
    return errors;
}

double ErrorEstimate::total() const { return std::hypot(noise, discretisation); }

ErrorEstimate estimate_error(const SolverState& state, ErrorMeasure measure) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double mean = error_reference(state, measure);
    if (!state.noise.is_known() || !(mean > 0)) return {infinity, infinity};
    const ErrorSums sums = sum_errors(state, measure, element_errors(state, measure));
    if (!(sums.weight > 0)) return {infinity, infinity};
    const double total_weight = measure == ErrorMeasure::surfaces ? sums.weight : 1;
    const double of_variations = error_of_variations(state.risk_check, sums.noise - sums.noise_of_patches, sums.bias);
    const double all = sums.noise_of_patches + of_variations + error_within_leaves(state.risk_check) + sums.assumed;
    const double discretisation = state.options.method.refines ? std::max(0.0, all - sums.noise) : 0;
    // Pixels without a surface have no error but count in the mean.
    const double shown = measure == ErrorMeasure::surfaces ? 1 : state.view.shown_share();
    const double scale = 1 / (mean * std::sqrt(total_weight * shown));
    return {std::sqrt(sums.noise) * scale, std::sqrt(discretisation) * scale};
}

}  // namespace interflect::detail
