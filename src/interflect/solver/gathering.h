#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/fixed_point.h"
#include "interflect/base/stable_array.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/radiosity.h"

namespace interflect::inline detail {

/// Importance that rays find where they arrive, added up for the leaves, or parts of luminaires, that they left: the
/// mean over a leaf's rays estimates the same transported importance as the rays that bring it there (Eq. 7), but from
/// where light starts. So it is known of small bright lamps, which few rays from the view ever meet.
class GatheredImportance {
  public:
    /// @param most_per_ray  What a ray can find at most. @param sources  That rays may leave.
    GatheredImportance(double most_per_ray, std::int64_t rays, std::size_t sources)
        : unit_(most_per_ray * static_cast<double>(rays)), sums_(sources) {}

    /// Adds what some rays of a source found; other threads may do so at the same time.
    void add(std::size_t source, double found) { add_concurrently(sums_[source], unit_.from(found)); }
    double sum(std::size_t source) const { return unit_.to_number(sums_[source]); }

  private:
    FixedPoint unit_;
    StableArray<std::int64_t> sums_;
};

}  // namespace interflect::inline detail
