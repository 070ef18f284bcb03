#include "interflect/solver/sampling/probabilities.h"

#include <cmath>
#include <utility>

#include "interflect/base/parallel.h"
#include "interflect/base/stable_array.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

struct Weights {
    double power = 0, importance = 0;
};
struct WeightSums {
    double power = 0, weighted_power = 0, power_nearby = 0, importance = 0;
    std::int64_t lost = 0;

    WeightSums& operator+=(const WeightSums& other) {
        power += other.power;
        weighted_power += other.weighted_power;
        power_nearby += other.power_nearby;
        importance += other.importance;
        lost += other.lost;
        return *this;
    }
};

WeightSums weigh_leaves(const SamplingWeights& s, const MixtureWeights& shares, StableArray<Weights>& weights) {
    const bool by_power = shares.power > 0 || shares.weighted_power > 0 || shares.power_nearby > 0;
    return parallel_sum(s.forest.size(), elements_at_once, WeightSums(), [&](std::size_t begin, std::size_t end) {
        WeightSums sums;
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            if (!s.forest.is_leaf(e)) continue;
            Weights w;
            if (by_power) {
                w.power = s.power(e);
                sums.lost += w.power == 0 && s.light.is_not_finite(s.forest, e);
            }
            if (shares.importance > 0) w.importance = s.importance(e);
            sums.power += w.power;
            sums.importance += w.importance;
            if (shares.weighted_power > 0) sums.weighted_power += w.power * s.importance_weight[e];
            if (shares.power_nearby > 0) sums.power_nearby += w.power * s.nearby[s.forest.patch(e)];
            weights[e] = w;
        }
        return sums;
    });
}

void weigh_parts(const SamplingWeights& s, const MixtureWeights& shares, WeightSums& sums) {
    for (std::size_t i = 0; i < s.part_count(); ++i) {
        const double power = channel_sum(s.emission->power(i));
        sums.power += power;
        if (shares.weighted_power > 0 && !s.part_importance.empty())
            sums.weighted_power += power * s.part_importance[i];
        if (shares.power_nearby > 0 && !s.part_importance.empty()) sums.power_nearby += power * s.part_nearby[i];
    }
}

}  // namespace

Mixture mixture(const SamplingWeights& sampled, const MixtureWeights& shares) {
    const ElementForest& forest = sampled.forest;
    StableArray<Weights> weights(forest.size());  // 0 for inner elements
    WeightSums sums = weigh_leaves(sampled, shares, weights);
    weigh_parts(sampled, shares, sums);
    const auto factor = [](double share, double of) { return of > 0 ? share / of : 0; };
    const double for_power = factor(shares.power, sums.power),
                 for_driven = factor(shares.weighted_power, sums.weighted_power),
                 for_nearby = factor(shares.power_nearby, sums.power_nearby),
                 for_importance = factor(shares.importance, sums.importance);
    std::vector<float> q(forest.size() + sampled.part_count());
    parallel_for_ranges(forest.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            double by_power = for_power;
            if (for_driven > 0) by_power += for_driven * sampled.importance_weight[e];
            if (for_nearby > 0) by_power += for_nearby * sampled.nearby[forest.patch(e)];
            const Weights& w = weights[e];
            q[e] = static_cast<float>(by_power * w.power + for_importance * w.importance);
        }
    });
    for (std::size_t i = 0; i < sampled.part_count(); ++i) {
        double by_power = for_power;
        if (sampled.part_importance.empty())  // unknown: the mean
            by_power = factor(shares.power + shares.weighted_power + shares.power_nearby, sums.power);
        else
            by_power += for_driven * sampled.part_importance[i] + for_nearby * sampled.part_nearby[i];
        q[forest.size() + i] = static_cast<float>(by_power * channel_sum(sampled.emission->power(i)));
    }
    return {std::move(q), sums.lost, sums.power, sums.weighted_power};
}

}  // namespace interflect::detail
