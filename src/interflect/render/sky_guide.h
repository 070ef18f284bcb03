#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/core.h"
#include "interflect/render/indirect_field.h"

namespace interflect::detail {

struct PathScene;

/// Directions towards the visible sky around the records of an IndirectField, for sampling: chance rarely finds a small
/// window (path guiding, Vorba et al. 2014). Each record has a density over cells of equal projected solid angle,
/// learned from rays of the records nearby. Immutable, thread-safe.
class SkyGuide {
  public:
    /// Empty without skies. If stopped, ends within milliseconds, with fewer densities.
    SkyGuide(const PathScene& scene, const IndirectField& field, const std::atomic<bool>* stop);

    /// Whether some ray from around a record has reached the sky.
    bool sees_sky(std::uint32_t record) const { return record < rows_.size() && rows_[record] != none; }
    /// @param record  That sees the sky; also below. @param n  Normal at the place. Numbers in [0, 1).
    V3f sample(std::uint32_t record, const V3f& n, double cell, float u, float v) const;
    /// Returns the density of sample() [1/sr].
    float density(std::uint32_t record, const V3f& n, const V3f& direction) const;

    std::int64_t rays() const { return rays_; }

  private:
    static constexpr std::size_t side = 16, cells = side * side;
    using Cells = std::array<float, cells>;
    using Cumulative = std::array<std::uint16_t, cells>;  // the last is max_cumulative
    static constexpr std::uint16_t max_cumulative = 0xFFFF;

    /// Adds squared luminances of the sky that a ray through each cell reaches. Returns the number of rays.
    static std::int64_t add_visible_sky(const PathScene& scene, const SurfacePoint& place, std::uint64_t key,
                                        Cells& squares);
    /// Densities follow the root mean square of the light in a cell (least variance), and extend to its neighbours.
    static Cumulative cumulative_of(const Cells& squares);

    std::vector<std::uint32_t> rows_;  // in densities_, by record
    std::vector<Cumulative> densities_;
    std::int64_t rays_ = 0;
};

}  // namespace interflect::detail
