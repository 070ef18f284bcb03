#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interflect/core.h"

namespace interflect::detail {

/// Density of directions from surfaces of similar normals, for sampling: constant over cells of equal projected solid
/// angle (path guiding, Vorba et al. 2014). Immutable, thread-safe.
class DirectionDensity {
  public:
    static constexpr std::size_t side = 16, cells = side * side;
    using Cells = std::array<float, cells>;

    /// Empty.
    DirectionDensity() = default;
    /// In proportion to `light`, extended to neighbouring cells; empty if it is 0.
    explicit DirectionDensity(const Cells& light);

    bool is_empty() const { return cumulative_.back() == 0; }
    /// Probability of a cell.
    float probability(std::size_t cell) const;
    /// @param x  In [0, 1).
    std::size_t cell_at(double x) const;
    /// @param n  Normal at the place. @param cell, u, v  In [0, 1).
    V3f sample(const V3f& n, double cell, float u, float v) const { return direction_in(cell_at(cell), n, u, v); }
    /// Returns the density of sample() [1/sr].
    float density(const V3f& n, const V3f& direction) const;

    static std::size_t cell_of(const V3f& n, const V3f& direction);
    /// Uniform in projected solid angle. @param u, v  In [0, 1).
    static V3f direction_in(std::size_t cell, const V3f& n, float u, float v);

  private:
    static constexpr std::uint16_t max_cumulative = 0xFFFF;
    std::array<std::uint16_t, cells> cumulative_{};  // the last is max_cumulative, or 0 if empty
};

}  // namespace interflect::detail
