#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/solver/radiosity.h"

namespace interflect::inline detail {

/// What the leaves of a forest may be sampled by. Weights are not normalised; numbers of equations in Prikryl et al.
/// 2000.
struct SamplingWeights {
    const Materials& materials;
    const ElementForest& forest;
    Radiosity light;                  ///< B [lm/m^2 or W/m^2].
    Importance reflected_importance;  ///< psi of Eq. 8 [1/m^2].
    std::span<const float>
        importance_weight;  ///< psi of Eq. 9 or 10, total or indirect importance, of every element [1/m^2].
    std::span<const float> nearby = {};           ///< The same of every patch, as it is in its neighbourhood.
    const Emission* emission = nullptr;           ///< Luminaires that shoot too; null: none do.
    std::span<const float> part_importance = {};  ///< psi of Eq. 10 of every part of them; empty: not known.
    std::span<const float> part_nearby = {};      ///< The same, as it is in parts alike.
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }

    /// Eq. 3: P_s, all channels together.
    double power(std::uint32_t s) const {
        return channel_sum(RgbD(light.of(forest, s))) * static_cast<double>(forest.area(s));
    }
    double power_nearby(std::uint32_t s) const { return power(s) * nearby[forest.patch(s)]; }
    /// Eq. 9 and 10: P_s psi_s.
    double weighted_power(std::uint32_t s) const { return power(s) * importance_weight[s]; }
    /// Eq. 8: rho_s I_s.
    double importance(std::uint32_t s) const {
        return static_cast<double>(materials.mean_reflectance(forest.patch(s), s)) * reflected_importance[s] *
               static_cast<double>(forest.area(s));
    }
};

/// How much of the rays each of the weights above gets (Eq. 11); a weight that is 0 everywhere leaves its share to the
/// others.
struct MixtureWeights {
    double power = 0, weighted_power = 0, importance = 0;
    double power_nearby = 0;  ///< By power times the importance nearby.
};

/// Who gets rays.
struct Mixture {
    /// Of every element, 0 for inner ones, then of every part; they sum to the shares that are used.
    std::vector<float> q;
    std::int64_t lost_leaves = 0;          ///< Those whose radiosity is not finite: nothing is shot from there.
    double power = 0, weighted_power = 0;  ///< Sums of these weights over the leaves, before they were normalised.
};
Mixture mixture(const SamplingWeights& sampled, const MixtureWeights& shares);

/// Importance as it should drive rays. That of a leaf comes from few rays, and where it is underestimated the few rays
/// that start there carry much: so an element has the share `from_parent` of what its parent has here. And what a
/// source deserves is the root of the mean square of what its rays meet, not the mean: of two sources of the same mean
/// that is greater for the one with few rays that matter (light that comes through a doorway); hence an exponent
/// below 1. (0, 1) leaves importance as it is, as in the paper.
std::vector<float> importance_weight(const ElementForest& forest, const Importance& importance, double from_parent,
                                     double exponent);

}  // namespace interflect::inline detail
