#include "interflect/solver/shrinkage/sibling_variation.h"

#include <algorithm>
#include <cmath>

namespace interflect::detail {

namespace {

/// Siblings count as under-sampled until they have received this fraction of their parent's rays.
constexpr float under_sampled = 0.125f;
/// Expected ratio of the signal of two successive levels at an edge, which is the largest expected ratio.
constexpr float highest_expected_decay = 0.5f;

}  // namespace

float SiblingVariation::shrinkage() const {
    const float kept = spread > noise ? 1 - noise / spread : 0.0f;
    return is_under_sampled() && kept > 0 ? std::min(kept, assumed / (assumed + noise)) : kept;
}

float SiblingVariation::risk() const {
    if (is_under_sampled()) {
        const float kept = shrinkage();
        return kept * kept * noise + (1 - kept) * (1 - kept) * assumed;
    }
    // James-Stein estimator: y, which is signal + noise in d = 3 dimensions, times max(0, 1 - d sigma^2 / |y|^2).
    return spread > noise ? noise + noise * (noise / (3 * spread)) : spread - noise;
}

bool uses_shrinkage(const LightState& light) {
    return light.options().experimental.shrinkage && refines_by_variance(light.options());
}

SiblingVariation sibling_variation(const LightState& light, ElementIndex first) {
    const ElementForest& forest = *light.forest;
    const std::vector<Rgb>& irradiance = light.solution.irradiance;
    if (light.history[first] == 0) return {0, std::numeric_limits<float>::infinity()};
    const float mean = luminance(irradiance[forest.parent(first)]);
    float area = 0, spread = 0, variance = 0;
    for (ElementIndex e = first; e < first + 4; ++e) {
        const float difference = luminance(irradiance[e]) - mean, a = forest.area(e);
        area += a;
        spread += a * difference * difference;
        variance += a * light.noise.variance(forest, irradiance, e, light.history[first]);
    }
    SiblingVariation variation{spread / area, variance / area};
    // With few rays, shrinkage by the measured signal leaves more noise than signal. The siblings of the parent bound
    // the signal.
    const ElementIndex parent = forest.parent(first);
    if (uses_shrinkage(light) && light.history[first] < under_sampled * light.history[parent])
        variation.assumed = parent < forest.patch_count()
                                ? std::pow(assumed_variation * mean, 2.0f)
                                : highest_expected_decay *
                                      std::max(0.0f, sibling_variation(light, first_sibling(forest, parent)).signal());
    return variation;
}

AddedError added_error(const LightState& light, ElementIndex first, const SiblingVariation& variation) {
    if (!variation.is_known()) return {};  // the siblings have the value of their parent
    if (!uses_shrinkage(light)) return {variation.noise, 0};
    const float kept = variation.shrinkage(), noise = kept * kept * variation.noise;
    // The variance of four non-negative numbers is at most 3 mean^2. This bounds the effect of rays with a large
    // weight.
    const float mean = luminance(light.solution.irradiance[light.forest->parent(first)]), most = 3 * mean * mean;
    return {noise, std::clamp(variation.risk() - noise, -most, most)};
}

/// Computes the factors of a Wiener filter (docs/method/method.md, Shrinkage).
Shrinkage shrinkage_of(const LightState& light, ElementIndex first, const SiblingVariation& variation) {
    const ElementForest& forest = *light.forest;
    Shrinkage s{{1, 1, 1, 1}, light.noise.shares(forest, light.solution.irradiance, first, light.history[first])};
    if (!uses_shrinkage(light) || !variation.is_known()) return s;
    const float kept = variation.shrinkage();
    float sum = 0, area = 0;
    for (std::uint32_t k = 0; k < 4; ++k) {
        s.kept[k] = kept > 0 ? kept / (kept + (1 - kept) * s.noise[k]) : 0;
        s.noise[k] = kept > 0 ? s.noise[k] * s.kept[k] : 1;
        sum += forest.area(first + k) * s.noise[k];
        area += forest.area(first + k);
    }
    for (float& noise : s.noise) noise = sum > 0 ? noise * area / sum : 1;
    return s;
}

float signal_among_siblings(const LightState& light, ElementIndex e) {
    if (e < light.forest->patch_count()) return 0;
    const SiblingVariation variation = sibling_variation(light, first_sibling(*light.forest, e));
    return variation.is_known() ? variation.signal() : 0;
}

}  // namespace interflect::detail
