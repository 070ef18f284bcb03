#pragma once

#include <cstdint>
#include <vector>

#include "interflect/luminaires/emission.h"
#include "interflect/solution.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/light/group_light.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/sampling/start_points.h"

namespace interflect::detail {

/// Sampling probabilities and payloads of the rays of a step.
struct RayPlan {
    /// Weight >= 0 of each element (0 for inner elements), then of each part of `emission`. If all are 0, no ray is
    /// shot.
    std::vector<float> q;
    std::int64_t rays = 0;  ///< Number N of rays, > 0.
    Radiosity light;        ///< Radiosity B that rays carry; empty: rays carry no power.
    const Emission* emission = nullptr;
    GroupRadiosity groups;  ///< Light groups whose light is received separately.
    /// Whether rays carry B_s over the sum of its channels in place of B_s A_s / (N q_s).
    bool equal_payloads = false;
    Importance importance;                      ///< Importance psi [1/m^2]; empty: rays carry no importance.
    const StartPoints* start_points = nullptr;  ///< Origins of reflected light; null: uniform origins.

    std::size_t part_count() const { return emission ? emission->part_count() : 0; }
    bool carries_power() const { return !light.empty(); }
    bool carries_importance() const { return !importance.empty(); }
};

/// A plan for power, with the sums of P_s (Eq. 3) and P_s psi_s (Eq. 9, 10; 0 if not used) over all sources.
struct PowerPlan {
    RayPlan plan;
    double power = 0, weighted_power = 0;
    std::int64_t non_finite_leaves = 0;  ///< Number of leaves that do not shoot, because their power is not finite.
};

/// Plans rays that carry power and, if `combined`, importance (Eq. 11, Prikryl et al. 2000; docs/method/method.md, One
/// step of transport). The plan refers to `so_far`, `emission` and `light`.
/// @param combined  Whether the rays also carry importance.
/// @param emission  Luminaires, which shoot if `light` emits.
PowerPlan plan_power(const Materials& materials, const Emission& emission, const Solution& so_far,
                     const Radiosity& light, const ImportanceWeights& weights, bool combined, std::int64_t rays);

/// Plans rays that carry importance alone (Eq. 8). The plan refers to `importance`.
RayPlan plan_importance(const Materials& materials, const Solution& so_far, const Importance& importance,
                        std::int64_t rays);

}  // namespace interflect::detail
