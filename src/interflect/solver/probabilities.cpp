#include "interflect/solver/probabilities.h"

#include <cmath>
#include <numeric>

namespace interflect {

namespace {

template <class Weight>
std::vector<double> for_leaves(const Sampled& s, const Weight& weight) {
    std::vector<double> w(s.leaves.size());
    for (std::size_t i = 0; i < w.size(); ++i)
        w[i] = weight(s.leaves[i]) * static_cast<double>(s.forest.area(s.leaves[i]));
    return w;
}

double radiosity_sum(const Rgb& b) { return channel_sum(RgbD(b)); }

}  // namespace

std::vector<double> power_weights(const Sampled& s, const std::vector<Rgb>& radiosity) {
    return for_leaves(s, [&](std::uint32_t e) { return radiosity_sum(radiosity[e]); });
}

std::vector<double> reflected_importance_weights(const Sampled& s, const std::vector<float>& importance) {
    return for_leaves(s, [&](std::uint32_t e) {
        return static_cast<double>(s.surfaces.mean_reflectance(s.forest.patch(e))) * importance[e];
    });
}

std::vector<double> driven_weights(const Sampled& s, const std::vector<Rgb>& radiosity,
                                   const std::vector<float>& importance) {
    return for_leaves(s, [&](std::uint32_t e) { return radiosity_sum(radiosity[e]) * importance[e]; });
}

std::vector<float> driving_importance(const ElementForest& forest, std::vector<float> importance, double from_parent,
                                      double exponent) {
    const auto share = static_cast<float>(from_parent), power = static_cast<float>(exponent);
    for (std::uint32_t e = forest.patch_count(); e < forest.size(); ++e)
        importance[e] += share * (importance[forest.parent(e)] - importance[e]);
    for (float& psi : importance) psi = std::pow(psi, power);
    return importance;
}

void mix_in(std::vector<double>& q, const std::vector<double>& weights, double share) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0)) return;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += share / sum * weights[i];
}

}  // namespace interflect
