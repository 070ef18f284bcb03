#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

/// Hit point at which reflected rays may start.
struct StartPoint {
    ElementIndex leaf;
    float power;                   ///< Received power, sum of the channels; in StartPoints, cumulative over the leaf.
    Parameters at;                 ///< Position on the leaf's patch.
    std::uint32_t place_on_curve;  ///< Morton code of `at`.

    StartPoint(std::uint32_t of_leaf, float of_power, const Parameters& point);
};

/// Origins of reflected light, in proportion to the received power. With uniform origins, reflection from a partly lit
/// leaf would be biased.
class StartPoints {
  public:
    StartPoints() = default;
    /// Accepts any order. Cost: O(n log n) on all threads.
    explicit StartPoints(std::vector<StartPoint> points);

    /// Returns the points of a leaf; if none, origins are uniform. Cost: O(log n).
    std::span<const StartPoint> of(ElementIndex leaf) const;
    const std::vector<StartPoint>& all() const { return points_; }

    /// Samples a point in proportion to its power. @param points  Not empty. @param u  Uniform random number in [0, 1).
    static Parameters choose(std::span<const StartPoint> points, float u);

  private:
    std::vector<StartPoint> points_;  // sorted by leaf, then along the Morton curve, which stratifies samples
};

}  // namespace interflect::detail
