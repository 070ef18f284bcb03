#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

/// Hit point at which reflected rays may start.
struct StartPoint {
    ElementIndex leaf;
    float power = 0;  ///< Received power, sum of the channels; in StartPoints, cumulative over the leaf.
    Parameters at;    ///< Position on the leaf's patch.
    std::uint32_t place_on_curve = 0;  ///< Morton code of `at`.

    StartPoint() = default;
    StartPoint(std::uint32_t of_leaf, float of_power, const Parameters& point);
};

/// Origins of reflected light, in proportion to the received power. With uniform origins, reflection from a partly lit
/// leaf would be biased.
class StartPoints {
  public:
    StartPoints() = default;
    /// Accepts any order and division into lists. Cost: O(n + leaves) and O(m log m) for the m points of a leaf, on all
    /// threads.
    /// @param leaf_end  Exceeds the index of every leaf.
    StartPoints(std::span<const std::vector<StartPoint>* const> lists, std::uint32_t leaf_end);
    StartPoints(const std::vector<StartPoint>& points, std::uint32_t leaf_end)
        : StartPoints(std::array{&points}, leaf_end) {}

    /// Returns the points of a leaf; if none, origins are uniform. Cost: O(1) on average.
    std::span<const StartPoint> of(ElementIndex leaf) const;
    const std::vector<StartPoint>& all() const { return points_; }

    /// Samples a point in proportion to its power. @param points  Not empty. @param u  Uniform random number in [0, 1).
    static Parameters choose(std::span<const StartPoint> points, float u);

  private:
    std::size_t bucket_of(std::uint32_t leaf) const { return leaf >> bucket_shift_; }
    std::span<StartPoint> bucket(std::size_t i) { return {points_.data() + first_[i], points_.data() + first_[i + 1]}; }
    std::span<const StartPoint> bucket(std::size_t i) const {
        return {points_.data() + first_[i], points_.data() + first_[i + 1]};
    }

    std::vector<StartPoint> points_;  // sorted by leaf, then along the Morton curve, which stratifies samples
    std::vector<std::size_t> first_;  // first point of each bucket of 2^bucket_shift_ leaves, then the number of points
    int bucket_shift_ = 0;
};

}  // namespace interflect::detail
