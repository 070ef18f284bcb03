#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/solver/deposit/oracle.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

struct TransportStep : RayPlan {
    explicit TransportStep(RayPlan plan = {}) : RayPlan(std::move(plan)) {}

    Radiosity oracle_light;  ///< Empty: `light`.
    const Radiosity& light_for_oracle() const { return oracle_light.empty() ? light : oracle_light; }
    bool importance_at_patches = false;
    Oracle oracle;
    bool completes_by_walks = false;
    /// Nonzero for leaves that reflect where they receive (StartPoints); may be empty.
    std::span<const std::uint8_t> reflecting_where_received;
    bool reflects_where_received(ElementIndex leaf) const {
        return !reflecting_where_received.empty() && reflecting_where_received[leaf] != 0;
    }
    /// Reused after tracing; may be null.
    std::vector<Rgb>* reusable_buffer = nullptr;
    /// Inner elements receive 0. Not with a refining oracle.
    bool leaves_only = false;
};

}  // namespace interflect::detail
