#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/patch_geometry.h"

namespace interflect::detail {

/// Point of a leaf that received power.
struct StartPoint {
    std::uint32_t leaf;
    float power;    ///< Sum of the channels [any unit]; in StartPoints cumulative over the leaf.
    Parameters at;  ///< On the leaf's patch.
};

/// Origins of reflected light. Uniform reflection from a partly lit leaf sends light to wrong surfaces, a bias that
/// only a finer mesh removes. A leaf with points here starts rays at them, in proportion to received power, as in
/// particle tracing.
class StartPoints {
  public:
    StartPoints() = default;
    /// @param points  Their order changes no bit. Cost: O(n log n) on all threads, 16 bytes per point.
    explicit StartPoints(std::vector<StartPoint> points);

    /// Returns the points of a leaf; empty if its rays start uniformly. Cost: O(log n).
    std::span<const StartPoint> of(std::uint32_t leaf) const;
    const std::vector<StartPoint>& all() const { return points_; }

    /// @param points  At least one, sampled by power. @param u  In [0, 1).
    static Parameters choose(std::span<const StartPoint> points, float u);

  private:
    std::vector<StartPoint> points_;  // by leaf, then along a Morton curve
};

}  // namespace interflect::detail
