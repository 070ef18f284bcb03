#include "interflect/solver/probabilities.h"

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

double at(const std::vector<float>& values, std::uint32_t e) { return values.empty() ? 0.0 : values[e]; }

double radiosity_sum(const Sampled& s, std::uint32_t e) { return channel_sum(RgbD(s.radiosity[e])); }

}  // namespace

std::vector<double> power_weights(const Sampled& s) {
    return for_leaves(s, [&](std::uint32_t e) { return radiosity_sum(s, e); });
}

std::vector<double> importance_weights(const Sampled& s) {
    return for_leaves(s, [&](std::uint32_t e) {
        return s.surfaces.mean_reflectance(s.forest.patch(e)) *
               (at(s.view_importance, e) + at(s.indirect_importance, e));
    });
}

std::vector<double> total_importance_weights(const Sampled& s) {
    return for_leaves(s, [&](std::uint32_t e) {
        return radiosity_sum(s, e) * (at(s.view_importance, e) + at(s.indirect_importance, e));
    });
}

std::vector<double> indirect_importance_weights(const Sampled& s) {
    return for_leaves(s, [&](std::uint32_t e) { return radiosity_sum(s, e) * at(s.indirect_importance, e); });
}

std::vector<double> view_weights(const Sampled& s) {
    return for_leaves(s, [&](std::uint32_t e) { return radiosity_sum(s, e) * at(s.view_importance, e); });
}

void mix_in(std::vector<double>& q, const std::vector<double>& weights, double share) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0)) return;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += share / sum * weights[i];
}

}  // namespace interflect
