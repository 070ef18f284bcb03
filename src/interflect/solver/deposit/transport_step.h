#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/solver/deposit/oracle.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

/// Rays of a step, and the treatment of their hits.
struct TransportStep : RayPlan {
    explicit TransportStep(RayPlan plan = {}) : RayPlan(std::move(plan)) {}

    Radiosity oracle_light;  ///< Radiosity that the oracle uses; empty: `light`.
    const Radiosity& light_for_oracle() const { return oracle_light.empty() ? light : oracle_light; }
    bool importance_at_patches = false;
    Oracle oracle;
    bool completes_by_walks = false;  ///< Whether random walks reflect the rays further (Walks).
    /// Per element: 1 if its reflected rays start at hit points (StartPoints), else 0. May be empty.
    std::span<const std::uint8_t> reflecting_where_received;
    bool reflects_where_received(ElementIndex leaf) const {
        return !reflecting_where_received.empty() && reflecting_where_received[leaf] != 0;
    }
    /// Memory that the step may reuse after tracing; may be null.
    std::vector<Rgb>* reusable_buffer = nullptr;
    /// Whether inner elements of the result are 0. Must be false if the oracle refines.
    bool leaves_only = false;
};

}  // namespace interflect::detail
