#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace interflect::detail {

/// Number of levels below the leaves to which variation is extrapolated.
inline constexpr std::size_t finer_levels = 6;

/// Sums of products of the mean and an independent iteration. Their expected values are squared errors and differences
/// without noise.
struct RiskCheck {
    double weight = 0;             ///< Total weight; 0 without data.
    double expected = 0;           ///< Squared errors after shrinkage, predicted by SiblingVariation::risk().
    double measured = 0;           ///< Squared errors after shrinkage, measured with the later iteration.
    double signal = 0;             ///< Squared differences of the leaves from their parents.
    double signal_of_parents = 0;  ///< Squared differences of the leaves' parents from their own parents.
    /// Part of `signal` that pictures would show if the descendants of leaves varied in the same way, by level.
    std::array<double, finer_levels> within{};

    RiskCheck& operator+=(const RiskCheck& o) { return add(1, o, 1); }
    /// Adds an iteration. @param share  Weight in [0, 1], smaller for short iterations.
    void add(const RiskCheck& fresh, double share) { add(1 - share / 2, fresh, share); }
    bool is_finite() const {
        // The sum is not finite if any term is not finite.
        double sum = weight + expected + measured + signal + signal_of_parents;
        for (const double level : within) sum += level;
        return std::isfinite(sum);
    }
    /// Returns the correction factor of predicted squared errors, from 0.1 to 10; 1 without data.
    double factor() const { return expected > 0 ? std::clamp(measured / expected, 0.1, 10.0) : 1; }

  private:
    RiskCheck& add(double old, const RiskCheck& o, double share) {
        const auto sum = [&](double& mine, double other) { mine = old * mine + share * other; };
        sum(weight, o.weight);
        sum(expected, o.expected);
        sum(measured, o.measured);
        sum(signal, o.signal);
        sum(signal_of_parents, o.signal_of_parents);
        for (std::size_t level = 0; level < finer_levels; ++level) sum(within[level], o.within[level]);
        return *this;
    }
};

}  // namespace interflect::detail
