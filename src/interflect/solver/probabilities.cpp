#include "interflect/solver/probabilities.h"

#include <cmath>
#include <utility>

#include "interflect/base/parallel.h"

namespace interflect {

namespace {

/// Sum of body(e) over the leaves, in double precision and always in the same order.
template <class T, class Body>
T sum_over_leaves(const ElementForest& forest, const Body& body) {
    return parallel_sum(forest.size(), elements_at_once, T(), [&](std::size_t begin, std::size_t end) {
        T sum{};
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e)
            if (forest.is_leaf(e)) sum += body(e);
        return sum;
    });
}

/// The weights of one element, or sums of them.
struct Weights {
    double power = 0, driven_power = 0, importance = 0;
    std::int64_t lost = 0;

    Weights() = default;
    Weights(const Sampled& s, const Shares& shares, std::uint32_t e) {
        if (shares.power > 0 || shares.driven_power > 0) {
            power = s.power(e);
            lost = power == 0 && s.light.is_lost(s.forest, e);
        }
        if (shares.driven_power > 0) driven_power = power * s.driver[e];
        if (shares.importance > 0) importance = s.importance(e);
    }
    Weights& operator+=(const Weights& other) {
        power += other.power;
        driven_power += other.driven_power;
        importance += other.importance;
        lost += other.lost;
        return *this;
    }
};

/// Raises numbers >= 0 to a power.
void raise(std::span<float> numbers, float exponent) {
    if (exponent == 0.75f) {  // the usual one takes square roots alone, many at a time
        for (float& x : numbers) x = std::sqrt(x) * std::sqrt(std::sqrt(x));
    } else {
        for (float& x : numbers) x = std::pow(x, exponent);
    }
}

}  // namespace

Mixture mixture(const Sampled& sampled, const Shares& shares) {
    const ElementForest& forest = sampled.forest;
    const auto sum = sum_over_leaves<Weights>(forest, [&](std::uint32_t e) { return Weights(sampled, shares, e); });
    const auto factor = [](double share, double of) { return of > 0 ? share / of : 0; };
    const double for_power = factor(shares.power, sum.power),
                 for_driven = factor(shares.driven_power, sum.driven_power),
                 for_importance = factor(shares.importance, sum.importance);
    std::vector<float> q(forest.size());
    parallel_for_ranges(q.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            if (!forest.is_leaf(e)) continue;
            const Weights w(sampled, shares, e);
            q[e] =
                static_cast<float>(for_power * w.power + for_driven * w.driven_power + for_importance * w.importance);
        }
    });
    return {std::move(q), sum.lost};
}

std::vector<float> driving_importance(const ElementForest& forest, const Importance& importance, double from_parent,
                                      double exponent) {
    const auto share = static_cast<float>(from_parent), power = static_cast<float>(exponent);
    std::vector<float> driver(forest.size());
    parallel_for_ranges(driver.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) driver[e] = importance[e];
    });
    forest.for_siblings_from_roots([&](std::uint32_t first) {
        const float parent = driver[forest.parent(first)];
        for (std::uint32_t e = first; e < first + 4; ++e) driver[e] += share * (parent - driver[e]);
    });
    if (power == 1) return driver;
    parallel_for_ranges(driver.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        raise(std::span(driver).subspan(begin, end - begin), power);
    });
    return driver;
}

}  // namespace interflect
