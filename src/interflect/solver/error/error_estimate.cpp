#include "interflect/solver/error/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/pixel_filter.h"
#include "interflect/solver/shrinkage/cluster_shrinkage.h"
#include "interflect/solver/shrinkage/sibling_variation.h"

namespace interflect::detail {

namespace {

/// Bounds of the factor by which mean squared differences decrease per level. It is 1/4 for smooth irradiance and 1/2
/// at edges; the upper bound leaves room for noise of the measured ratio.
constexpr double min_decay = 0.25, max_decay = 0.7;

struct ErrorSums {
    double weight = 0, noise = 0, bias = 0;
    double noise_of_patches = 0, bias_of_patches = 0;
    double assumed_bias = 0;  // bias within undivided patches

    ErrorSums& operator+=(const ErrorSums& o) {
        weight += o.weight;
        noise += o.noise;
        bias += o.bias;
        noise_of_patches += o.noise_of_patches;
        bias_of_patches += o.bias_of_patches;
        assumed_bias += o.assumed_bias;
        return *this;
    }
};

ErrorSums sum_errors(const SolverState& state, ErrorMeasure measure, const ElementErrors& errors) {
    const ElementForest& forest = *state.light.forest;
    const auto sum = [&](std::size_t begin, std::size_t end) {
        ErrorSums sums;
        for (ElementIndex e(begin); e < end; ++e) {
            if (!forest.is_leaf(e)) continue;
            const double w = error_weight(state.inputs, state.light, measure, e) * forest.area(e);
            if (!(w > 0)) continue;
            sums.weight += w;
            sums.noise += w * errors.noise[e];
            sums.bias += w * errors.bias[e];
            sums.noise_of_patches += w * errors.noise_of_patch[e];
            sums.bias_of_patches += w * errors.bias[forest.patch(e)];
            if (e >= forest.patch_count()) continue;
            const float variation = assumed_variation * luminance(state.light.solution.irradiance[e]);
            sums.assumed_bias += w * shown_within(state.inputs, state.light, measure, e)[0] * variation * variation;
        }
        return sums;
    };
    return parallel_sum(state.work.stop.ranks(), forest.size(), elements_per_task, ErrorSums(), sum);
}

/// Returns the squared error of levels below the leaves, by extrapolating the differences of leaves from their parents.
double error_within_leaves(const RiskCheck& check) {
    if (!(check.weight > 0)) return 0;
    const bool is_known = check.signal > 0 && check.signal_of_parents > 0;
    const double decay =
        is_known ? std::clamp(check.signal / check.signal_of_parents, min_decay, max_decay) : min_decay;
    double sum = 0, level_factor = 1;
    for (const double within : check.within) {
        level_factor *= decay;
        sum += std::max(0.0, within) * level_factor;
    }
    return sum / check.weight;
}

/// Returns noise + bias, corrected by the factor of the RiskCheck. If the bias is strongly negative, returns the
/// squared error that the RiskCheck has measured (docs/method/method.md, Errors).
double squared_error_of_differences(const RiskCheck& check, double noise_of_differences, double bias) {
    const double expected = noise_of_differences + bias;
    const bool is_reliable = bias > -noise_of_differences / 2;
    return is_reliable || !(check.weight > 0) ? check.factor() * expected
                                              : std::max(0.0, check.measured / check.weight);
}

/// Sets the errors of the patch means after shrinkage towards the clusters of the first tree. The average over all
/// trees, which is the result, has slightly smaller errors.
void set_errors_of_clusters(const RunInputs& inputs, const LightState& light, ErrorMeasure measure,
                            ElementErrors& errors) {
    const ElementForest& forest = *light.forest;
    const PatchClusters& clusters = inputs.clusters.front();
    std::vector<ClusterShrinkage::Errors> of_patches(forest.patch_count());
    ClusterShrinkage(light, clusters, light.solution.irradiance).measure_errors(of_patches, [&](std::size_t node) {
        return measure == ErrorMeasure::surfaces ? 1.0f : shown_of_cluster(inputs.cluster_pixels[node]);
    });
    for (std::size_t p = 0; p < of_patches.size(); ++p) {
        errors.noise[p] = of_patches[p].noise;
        errors.bias[p] = of_patches[p].bias;
    }
}

void set_errors_of_patches(const RunInputs& inputs, const LightState& light, ErrorMeasure measure,
                           ElementErrors& errors) {
    if (!inputs.clusters.empty()) return set_errors_of_clusters(inputs, light, measure, errors);
    const ElementForest& forest = *light.forest;
    parallel_for_ranges(forest.patch_count(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (PatchIndex root(begin); root < end; ++root) {
            const float shown = shown_of_patch(inputs, light, measure, root);
            const float rays = std::max(light.history[root], 1.0f);
            errors.noise[root] = shown * light.noise.variance(forest, light.solution.irradiance, root, rays);
        }
    });
}

}  // namespace

ElementErrors element_errors(const RunInputs& inputs, const LightState& light, ErrorMeasure measure) {
    const ElementForest& forest = *light.forest;
    ElementErrors errors;
    errors.noise.assign(forest.size(), 0);
    errors.bias.assign(forest.size(), 0);
    set_errors_of_patches(inputs, light, measure, errors);
    errors.noise_of_patch = errors.noise;
    forest.for_siblings_from_roots([&](ElementIndex first) {
        const ElementIndex parent = forest.parent(first);
        if (measure == ErrorMeasure::pictures && light.solution.view_importance[parent] == 0) return;
        const SiblingVariation variation = sibling_variation(light, first);
        const auto [noise, bias] = added_error(light, first, variation);
        const float shown = shown_of_siblings(inputs, light, measure, first);
        const Shrinkage shrinkage = shrinkage_of(light, first, variation);
        for (ElementIndex e = first; e < first + 4; ++e) {
            const float noise_share = shrinkage.noise[e - first];
            errors.noise[e] = noise_share * (errors.noise[parent] + shown * noise);
            errors.noise_of_patch[e] = noise_share * errors.noise_of_patch[parent];
            errors.bias[e] = errors.bias[parent] + shown * bias;
        }
    });
    return errors;
}

double ErrorEstimate::total() const { return std::hypot(noise, discretisation); }

ErrorEstimate estimate_error(const SolverState& state, ErrorMeasure measure) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double mean = error_reference(state.inputs, state.light, measure);
    if (!state.light.noise.is_known() || !(mean > 0)) return {infinity, infinity};
    const ErrorSums sums = sum_errors(state, measure, element_errors(state.inputs, state.light, measure));
    if (!(sums.weight > 0)) return {infinity, infinity};
    const double total_weight = measure == ErrorMeasure::surfaces ? sums.weight : 1;
    const double squared_total =
        sums.noise_of_patches + sums.bias_of_patches +
        squared_error_of_differences(state.light.risk_check, sums.noise - sums.noise_of_patches,
                                     sums.bias - sums.bias_of_patches) +
        error_within_leaves(state.light.risk_check) + sums.assumed_bias;
    const double squared_discretisation =
        state.light.options().method.refines ? std::max(0.0, squared_total - sums.noise) : 0;
    // `mean` and `sums` are averages over pixels with a surface, a share s of the picture. Averages over the whole
    // picture are s times as large.
    const double surface_share = measure == ErrorMeasure::surfaces ? 1 : state.sampling.view.surface_share();
    const double scale = 1 / (mean * std::sqrt(total_weight * surface_share));
    return {std::sqrt(sums.noise) * scale, std::sqrt(squared_discretisation) * scale};
}

}  // namespace interflect::detail
