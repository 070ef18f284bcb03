#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "interflect/base/numbers/fixed_point.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/deposit/found_importance.h"
#include "interflect/solver/deposit/ray_pairs.h"
#include "interflect/solver/deposit/source_paths.h"
#include "interflect/solver/deposit/transport_step.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/sampling/start_points.h"

namespace interflect::detail {

/// Rays that left the scene, and their power [units of ContributionUnits::power].
struct Escaped {
    FixedPoint::Value power{};
    std::int64_t rays = 0;

    Escaped& operator+=(const Escaped& other) {
        for (std::size_t c = 0; c < 3; ++c) power[c] += other.power[c];
        rays += other.rays;
        return *this;
    }
};

/// Finds the elements on which rays are deposited, by descending from the hit patches. Each thread has its own object.
/// Many rays descend together, for vector code and to hide memory latency.
class Descent {
    using Terms = ContributionSums::ScatterBuffer::Terms;

  public:
    /// Arguments must outlive this.
    /// @param old_size    Size of the forest before the step.
    /// @param importance  Receives the importance at hit points; may be null.
    Descent(const Materials& materials, ElementForest& forest, const TransportStep& step, std::uint32_t old_size,
            ContributionSums& sums, FoundImportance* importance)
        : materials_(materials),
          forest_(forest),
          step_(step),
          old_size_(old_size),
          refines_(step.oracle.refines && step.carries_power()),
          needs_leaf_(!refines_ || (step.carries_importance() && !step.importance_at_patches)),
          may_grow_(old_size + std::size_t{4} <= step.oracle.max_elements),
          buffer_(sums),
          found_importance_(importance),
          source_paths_(forest, step) {
        std::iota(active_.begin(), active_.end(), 0u);
        pairs_.next.fill(none);
    }

    /// Deposits rays of one source.
    /// @param source       Leaf, or old_size + luminaire part.
    /// @param contribution, power_by_group  Contribution of each ray.
    /// @param origins      Start points on the leaf's patch; ignored for luminaire parts.
    /// @param transmitted  Transmittance of panes in front of the hits; scales the found importance.
    void deposit(std::uint32_t source, const Contribution& contribution, std::span<const std::int64_t> power_by_group,
                 std::span<const Ray> rays, std::span<const Parameters> origins, std::span<const Hit> hits,
                 float transmitted = 1);
    void prefetch(const Hit& hit) const;
    /// Completes the descent of all rays.
    void finish_task();
    void deposit_at(ElementIndex leaf, const Contribution& contribution, std::span<const std::int64_t> power_by_group) {
        buffer_.add(leaf, buffer_.add_payload(contribution, power_by_group), Terms::power);
    }
    void count_escaped(const Contribution& contribution) {
        for (std::size_t c = 0; c < 3; ++c) escaped_.power[c] += contribution[c];
        ++escaped_.rays;
    }
    const std::vector<StartPoint>& start_points() const { return start_points_; }
    Escaped finish();

  private:
    static constexpr std::size_t lanes = RayPairs::lanes;
    struct RayState {
        std::uint32_t payload;  // index of the payload in buffer_
        PatchIndex patch;       // patch that the ray hits
        std::uint32_t source_in_task;
        Parameters start;
        Rgb reflectance{0, 0, 0};  // reflectance rho_i of the hit patch
    };

    using Lanes = std::array<std::uint32_t, lanes>;
    std::span<const std::uint32_t> active() const { return std::span(active_).first(active_count_); }
    template <class Condition>
    std::span<const std::uint32_t> active_lanes_if(Lanes& found, const Condition& condition) const;
    void begin(std::uint32_t payload, std::uint32_t source_in_task, const Ray& ray, const Parameters& start,
               const Hit& hit);
    void advance();
    void look_up_receiver(std::size_t i);
    void provide_children(std::size_t i);
    void deposit_ray(std::size_t i);
    void add_start_point(ElementIndex leaf, const Parameters& at, const Contribution& contribution);
    void add_found_importance(std::uint32_t source_in_task, PatchIndex patch, ElementIndex element);

    const Materials& materials_;
    ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t old_size_;
    bool refines_, needs_leaf_, may_grow_;
    ContributionSums::ScatterBuffer buffer_;
    Escaped escaped_;
    std::vector<StartPoint> start_points_;
    FoundImportance* found_importance_;
    struct SourceInTask {
        std::uint32_t source;
        double found;  // sum of the importance at the hits of its rays
        float transmitted;
    };
    std::vector<SourceInTask> sources_in_task_;
    RayPairs pairs_{};
    std::array<RayState, lanes> rays_;
    Lanes active_;  // indices of the `active_count_` lanes in use, then of the free lanes
    std::size_t active_count_ = 0;
    SourcePaths source_paths_;
    SourcePaths::Path path_;
};

}  // namespace interflect::detail
