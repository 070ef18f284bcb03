#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/solver/radiosity.h"

namespace interflect::inline detail {

/// Unnormalised weights for sampling the leaves of a forest. Equations: Prikryl et al. 2000.
struct SamplingWeights {
    const Materials& materials;
    const ElementForest& forest;
    Radiosity light;                  ///< B [lm/m^2 or W/m^2].
    Importance reflected_importance;  ///< psi of Eq. 8 [1/m^2].
    std::span<const float>
        importance_weight;  ///< psi of Eq. 9 or 10 (total or indirect importance) of every element [1/m^2].
    std::span<const float> nearby = {};           ///< Mean of the neighbourhood, for every patch.
    const Emission* emission = nullptr;           ///< Luminaires that shoot; null: none.
    std::span<const float> part_importance = {};  ///< psi of Eq. 10 of every luminaire part; empty: unknown.
    std::span<const float> part_nearby = {};      ///< Mean of similar parts.
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }

    /// Eq. 3: P_s, summed over the channels.
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

/// Share of rays for each of these weights (Eq. 11). The others take over the share of a weight that is 0 everywhere.
struct MixtureWeights {
    double power = 0, weighted_power = 0, importance = 0;
    double power_nearby = 0;  ///< By power times neighbourhood importance.
};

/// Sampling distribution of the rays.
struct Mixture {
    /// For every element (0 for inner ones), then every luminaire part. Sums to the shares in use.
    std::vector<float> q;
    std::int64_t lost_leaves = 0;          ///< Leaves with non-finite radiosity; they shoot no rays.
    double power = 0, weighted_power = 0;  ///< Sums of the weights before normalisation.
};
Mixture mixture(const SamplingWeights& sampled, const MixtureWeights& shares);

/// Smooths importance for sampling. The importance of a leaf is estimated from few rays. If it is too low, the few rays
/// that start there have large weights. So a share `from_parent` of the parent's result is mixed in. The optimal
/// density of rays is proportional to the root mean square of the importance that they meet, not to its mean. It is
/// higher for sources with few important rays (light through a doorway), hence an exponent below 1. (0, 1) returns the
/// importance itself, as in the paper.
std::vector<float> importance_weight(const ElementForest& forest, const Importance& importance, double from_parent,
                                     double exponent);

}  // namespace interflect::inline detail
