#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/solver/deposit/oracle.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

/// One step of transport: the rays of a plan and the receivers of their payload.
struct TransportStep : RayPlan {
    explicit TransportStep(RayPlan plan = {}) : RayPlan(std::move(plan)) {}

    Radiosity known_light;  ///< Radiosity for the oracle, shot or not; empty: `light`.
    const Radiosity& light_for_oracle() const { return known_light.empty() ? light : known_light; }
    bool importance_at_patches = false;  ///< Patches receive importance, not leaves.
    Oracle oracle;
    /// Random walks complete the transport of this power, which no later step reflects (Walks).
    bool to_the_end = false;
    /// Nonzero for leaves that reflect where they receive, or empty. Received::start_points contains their points.
    std::span<const std::uint8_t> reflecting_where_received;
    bool reflects_where_received(std::uint32_t leaf) const {
        return !reflecting_where_received.empty() && reflecting_where_received[leaf] != 0;
    }
    /// Buffer to reuse after all rays are traced, such as that of `light`, or null.
    std::vector<Rgb>* spent = nullptr;
    /// Received values of inner elements stay 0. Not with a refining oracle.
    bool leaves_only = false;
};

}  // namespace interflect::detail
