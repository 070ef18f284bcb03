#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "interflect/geometry/patch_geometry.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// A point of a leaf that received power.
struct StartPoint {
    std::uint32_t leaf;
    float power;    ///< Sum of the channels [any unit]; in StartPoints: cumulative over the points of the leaf.
    Parameters at;  ///< On the leaf's patch.
};

/// Origins of reflected light. A leaf that receives light in one corner and reflects it uniformly sends light to wrong
/// surfaces, a bias that only a finer mesh removes. A leaf with points here starts its rays at these points, in
/// proportion to the received power, like particle tracing.
class StartPoints {
  public:
    StartPoints() = default;
    /// @param points  In any order, with the same bits. Cost: O(n log n) on all threads, 16 bytes per point.
    explicit StartPoints(std::vector<StartPoint> points);

    /// Returns the points of a leaf; empty if its rays start uniformly. Cost: O(log n).
    std::span<const StartPoint> of(std::uint32_t leaf) const;
    const std::vector<StartPoint>& all() const { return points_; }

    /// Samples a point in proportion to power. @param points  At least one. @param u  In [0, 1).
    static Parameters choose(std::span<const StartPoint> points, float u);

    void archive(StateArchive& archive, const std::string& name) { archive(name, points_); }
    /// Whether all points lie on leaves of a forest with this number of elements.
    bool fit(std::size_t elements) const { return points_.empty() || points_.back().leaf < elements; }

  private:
    std::vector<StartPoint> points_;  // by leaf, then along a space-filling curve
};

}  // namespace interflect::inline detail
