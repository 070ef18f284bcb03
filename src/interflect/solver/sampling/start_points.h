#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

struct StartPoint {
    ElementIndex leaf;
    float power;                   ///< Sum of the channels; cumulative over the leaf in StartPoints.
    Parameters at;                 ///< On the leaf's patch.
    std::uint32_t place_on_curve;  ///< Morton code of `at`.

    StartPoint(std::uint32_t of_leaf, float of_power, const Parameters& point);
};

/// Origins of reflected light, in proportion to received power. Uniform reflection from a partly lit leaf is biased.
class StartPoints {
  public:
    StartPoints() = default;
    /// Accepts any order. Cost: O(n log n) on all threads.
    explicit StartPoints(std::vector<StartPoint> points);

    /// Empty: uniform origins. Cost: O(log n).
    std::span<const StartPoint> of(ElementIndex leaf) const;
    const std::vector<StartPoint>& all() const { return points_; }

    /// Samples a point by power. @param points  Not empty. @param u  In [0, 1).
    static Parameters choose(std::span<const StartPoint> points, float u);

  private:
    std::vector<StartPoint> points_;  // by leaf, then along the curve, which stratifies samples
};

}  // namespace interflect::detail
