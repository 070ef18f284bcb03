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
    Radiosity light;                              ///< B [lm/m^2 or W/m^2].
    Importance reflected_importance;              ///< psi of Eq. 8 [1/m^2].
    std::span<const float> importance_weight;     ///< psi of Eq. 9 or 10 by element [1/m^2]
    std::span<const float> nearby = {};           ///< Mean of each patch's neighbourhood.
    const Emission* emission = nullptr;           ///< Luminaires that shoot, or null.
    std::span<const float> part_importance = {};  ///< psi of Eq. 10 by luminaire part; empty: unknown.
    std::span<const float> part_nearby = {};      ///< Mean over the parts of the emitter.
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }

    /// Eq. 3: P_s, summed over the channels.
    double power(ElementIndex s) const {
        return channel_sum(RgbD(light.of(forest, s))) * static_cast<double>(forest.area(s));
    }
    double power_nearby(ElementIndex s) const { return power(s) * nearby[forest.patch(s)]; }
    /// Eq. 9 and 10: P_s psi_s.
    double weighted_power(ElementIndex s) const { return power(s) * importance_weight[s]; }
    /// Eq. 8: rho_s I_s.
    double importance(ElementIndex s) const {
        return static_cast<double>(materials.mean_reflectance(forest.patch(s), s)) * reflected_importance[s] *
               static_cast<double>(forest.area(s));
    }
};

/// Shares of rays (Eq. 11). A weight of 0 everywhere leaves its share to the others.
struct MixtureWeights {
    double power = 0, weighted_power = 0, importance = 0;
    double power_nearby = 0;
};

struct Mixture {
    /// Probability by element (0 for inner ones), then by luminaire part. Sums to the shares in use.
    std::vector<float> q;
    std::int64_t non_finite_leaves = 0;
    double power = 0, weighted_power = 0;
};
Mixture mixture(const SamplingWeights& sampled, const MixtureWeights& shares);

}  // namespace interflect::detail
