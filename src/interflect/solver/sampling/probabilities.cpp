#include "interflect/solver/sampling/probabilities.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

struct WeightSums {
    double power = 0, weighted_power = 0, power_nearby = 0, importance = 0;
    std::int64_t non_finite = 0;

    WeightSums& operator+=(const WeightSums& other) {
        power += other.power;
        weighted_power += other.weighted_power;
        power_nearby += other.power_nearby;
        importance += other.importance;
        non_finite += other.non_finite;
        return *this;
    }
};

/// Computes the sums of the weights of leaves.
/// @param powers       Receives the power of each leaf, and 0 for inner elements.
/// @param importances  Receives the same for importance. Empty if no rays are sampled by importance.
WeightSums weigh_leaves(const SamplingWeights& s, const MixtureWeights& shares, std::span<double> powers,
                        std::span<double> importances) {
    const bool by_power = shares.power > 0 || shares.weighted_power > 0 || shares.power_nearby > 0;
    return parallel_sum(s.forest.size(), elements_per_task, WeightSums(), [&](std::size_t begin, std::size_t end) {
        WeightSums sums;
        std::ranges::fill(powers.subspan(begin, end - begin), 0.0);
        if (!importances.empty()) std::ranges::fill(importances.subspan(begin, end - begin), 0.0);
        for (ElementIndex e(begin); e < end; ++e) {
            if (importances.empty() && !s.light.may_shine(e)) continue;
            if (!s.forest.is_leaf(e)) continue;
            if (!importances.empty()) {
                const double importance = s.importance(e);
                sums.importance += importance;
                importances[e] = importance;
            }
            if (!by_power) continue;
            const double power = s.power(e);
            sums.non_finite += power == 0 && s.light.is_not_finite(s.forest, e);
            sums.power += power;
            if (shares.weighted_power > 0) sums.weighted_power += power * s.importance_weight[e];
            if (shares.power_nearby > 0) sums.power_nearby += power * s.nearby[s.forest.patch(e)];
            powers[e] = power;
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
    // The threads of weigh_leaves() clear the memory
    const std::size_t importance_count = shares.importance > 0 ? forest.size() : 0;
    const auto memory = std::make_unique_for_overwrite<double[]>(forest.size() + importance_count);
    const std::span<double> powers(memory.get(), forest.size());
    const std::span<double> importances(memory.get() + forest.size(), importance_count);
    WeightSums sums = weigh_leaves(sampled, shares, powers, importances);
    weigh_parts(sampled, shares, sums);
    const auto factor = [](double share, double of) { return of > 0 ? share / of : 0; };
    const double for_power = factor(shares.power, sums.power),
                 for_weighted = factor(shares.weighted_power, sums.weighted_power),
                 for_nearby = factor(shares.power_nearby, sums.power_nearby),
                 for_importance = factor(shares.importance, sums.importance);
    std::vector<float> q(forest.size() + sampled.part_count());
    parallel_for_ranges(forest.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) {
            const double importance = importances.empty() ? 0 : for_importance * importances[e];
            double by_power = for_power;
            if (powers[e] > 0 && for_weighted > 0) by_power += for_weighted * sampled.importance_weight[e];
            if (powers[e] > 0 && for_nearby > 0) by_power += for_nearby * sampled.nearby[forest.patch(e)];
            q[e] = static_cast<float>(by_power * powers[e] + importance);
        }
    });
    for (std::size_t i = 0; i < sampled.part_count(); ++i) {
        double by_power = for_power;
        if (sampled.part_importance.empty())  // unknown importance is replaced by its mean
            by_power = factor(shares.power + shares.weighted_power + shares.power_nearby, sums.power);
        else
            by_power += for_weighted * sampled.part_importance[i] + for_nearby * sampled.part_nearby[i];
        q[forest.size() + i] = static_cast<float>(by_power * channel_sum(sampled.emission->power(i)));
    }
    return {std::move(q), sums.non_finite, sums.power, sums.weighted_power};
}

}  // namespace interflect::detail
