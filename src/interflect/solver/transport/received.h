#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/deposit/contribution_units.h"
#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/deposit/found_importance.h"
#include "interflect/solver/deposit/transport_step.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/sampling/payload.h"
#include "interflect/solver/sampling/start_points.h"

namespace interflect::detail {

/// Results of a step by element. Inner elements have the mean of their children.
struct Received {
    std::vector<Rgb> irradiance;  ///< [lm/m^2 or W/m^2]
    /// Variance of the luminance of `irradiance`, for independent rays (Poisson).
    std::vector<float> variance;
    GroupLight groups;              ///< `irradiance` of each light group.
    std::vector<float> importance;  ///< Importance per area; empty if the rays carry none.
    /// Sum of rho psi at the hits of each part's rays; empty without importance.
    std::vector<PartImportance> part_importance;
    StartPoints start_points;  ///< Hit points on leaves in reflecting_where_received.
    PayloadHistogram payloads;
    RgbD shot_power{0, 0, 0};  ///< Received plus escaped power [lm or W].
    RgbD escaped_power{0, 0, 0};
    std::int64_t escaped_rays = 0;
};

/// Converts contributions to received values, and resets the contributions to 0. Sorts the new elements, and merges
/// elements beyond the oracle's limit into their parents. Reuses buffers of the step.
/// @param importance  Importance found by the rays, or null.
/// @param ranks       Ranks whose contributions are added; null: this process is alone.
Received collect(TransportStep& step, ElementForest& forest, std::uint32_t old_size, const RayAllocation& allocation,
                 const PayloadTotals& payload, const ContributionUnits& units, const FoundImportance* importance,
                 ContributionSums& sums, Ranks* ranks);

Received nothing_received(const TransportStep& step, std::size_t elements);

/// Computes the variance of parents, whose values are area-weighted means of independent children.
inline void pull_variance(const ElementForest& forest, std::vector<float>& variance) {
    forest.for_siblings_from_leaves([&](ElementIndex first) {
        double sum = 0, area = 0;  // squared areas exceed the range of a float
        for (ElementIndex e = first; e < first + 4; ++e) {
            const double part = forest.area(e);
            sum += variance[e] * part * part;
            area += part;
        }
        variance[forest.parent(first)] = static_cast<float>(sum / (area * area));
    });
}

}  // namespace interflect::detail
