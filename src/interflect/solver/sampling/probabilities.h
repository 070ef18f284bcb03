#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/solver/light/radiosity.h"

namespace interflect::detail {

/// Unnormalised weights of leaves and luminaire parts (Prikryl et al. 2000).
struct SamplingWeights {
    const Materials& materials;
    const ElementForest& forest;
    Radiosity light;                              ///< Radiosity B [lm/m^2 or W/m^2].
    Importance reflected_importance;              ///< Importance psi in Eq. 8 [1/m^2].
    std::span<const float> importance_weight;     ///< Importance psi in Eq. 9 or 10, by element [1/m^2].
    std::span<const float> nearby = {};           ///< Mean importance in the neighbourhood of each patch.
    const Emission* emission = nullptr;           ///< Luminaires that shoot rays, or null.
    std::span<const float> part_importance = {};  ///< Importance psi in Eq. 10, by luminaire part; empty: unknown.
    std::span<const float> part_nearby = {};      ///< Mean importance of the parts of the same emitter.
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }

    /// Returns P_s of Eq. 3, summed over the channels.
    double power(ElementIndex s) const {
        return channel_sum(RgbD(light.of(forest, s))) * static_cast<double>(forest.area(s));
    }
    double power_nearby(ElementIndex s) const { return power(s) * nearby[forest.patch(s)]; }
    /// Returns P_s psi_s of Eq. 9 and 10.
    double weighted_power(ElementIndex s) const { return power(s) * importance_weight[s]; }
    /// Returns rho_s I_s of Eq. 8.
    double importance(ElementIndex s) const {
        return static_cast<double>(materials.mean_reflectance(forest.patch(s), s)) * reflected_importance[s] *
               static_cast<double>(forest.area(s));
    }
};

/// Shares of the rays that are sampled by each weight (Eq. 11). If a weight is 0 everywhere, the other weights take
/// over its share.
struct MixtureWeights {
    double power = 0, weighted_power = 0, importance = 0;
    double power_nearby = 0;
};

struct Mixture {
    /// Probability of each element (0 for inner elements), then of each luminaire part. The probabilities sum to the
    /// sum of the used shares.
    std::vector<float> q;
    std::int64_t non_finite_leaves = 0;
    double power = 0, weighted_power = 0;
};
Mixture mixture(const SamplingWeights& sampled, const MixtureWeights& shares);

}  // namespace interflect::detail
