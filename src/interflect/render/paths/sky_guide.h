#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/render/paths/indirect_field.h"

namespace interflect::detail {

/// Samples directions towards the visible sky around the records of an IndirectField, because cosine-distributed
/// directions rarely find a small window (path guiding, Vorba et al. 2014). Records in reach of the same record share a
/// density over cells of equal projected solid angle, learned from their rays. Immutable, thread-safe.
class SkyGuide {
  public:
    /// Learns the densities; the guide is empty if the scene has no sky. After a stop, it has fewer densities and ends
    /// within milliseconds, except that with several ranks it runs to its end. Collective.
    SkyGuide(const TracedScene& scene, const IndirectField& field, std::uint64_t seed, const CommonStop& stop);

    /// Whether some ray from around a record has reached the sky.
    bool sees_sky(std::uint32_t record) const {
        return record < groups_.size() && densities_[groups_[record]].back() > 0;
    }
    /// Samples a direction. @param record  Must see the sky, also for density().
    /// @param n           Normal of the surface.
    /// @param cell, u, v  Random numbers in [0, 1).
    V3f sample(std::uint32_t record, const V3f& n, double cell, float u, float v) const;
    /// Returns the density of sample() [1/sr].
    float density(std::uint32_t record, const V3f& n, const V3f& direction) const;

    std::int64_t rays() const { return rays_; }

  private:
    static constexpr std::size_t side = 16, cells = side * side;
    using Cells = std::array<float, cells>;
    using Cumulative = std::array<std::uint16_t, cells>;  // the last entry is max_cumulative, or 0 without visible sky
    static constexpr std::uint16_t max_cumulative = 0xFFFF;

    /// Rays from some points, and the light of the sky that they found.
    struct Search {
        const TracedScene& scene;
        std::span<const SurfacePoint> points;
        std::uint64_t key;
        Cells rays{}, squares{};  // number of rays in each cell, and sum of the squared luminances that they found
        std::int64_t traced = 0;  // number of traced rays, with those behind panes

        void trace_uniformly();
        void trace_guided_by(const Cumulative& density);
        void trace(std::span<const std::uint8_t, cells> cells_of_rays);
        /// Returns the root mean square of the light in each cell. Densities in proportion to it have the least
        /// variance.
        Cells light() const;
    };
    static Search search(const TracedScene& scene, std::span<const SurfacePoint> points, std::uint64_t key);
    /// Returns a density in proportion to the light, with a share of the light of neighbouring cells.
    static Cumulative density_of(const Cells& light);
    static std::size_t cell_at(const Cumulative& density, double x);

    std::vector<std::uint32_t> groups_;  // by record
    std::vector<Cumulative> densities_;  // by group
    std::int64_t rays_ = 0;
};

}  // namespace interflect::detail
