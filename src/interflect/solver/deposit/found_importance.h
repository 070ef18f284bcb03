#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/fixed_point.h"
#include "interflect/base/stable_array.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/light/radiosity.h"

namespace interflect::detail {

/// Importance at hit points, summed by source. The mean over a leaf's rays estimates its transported importance (Eq. 7,
/// Prikryl et al. 2000).
class FoundImportance {
  public:
    FoundImportance(double max_per_ray, std::int64_t rays, std::size_t sources)
        : unit_(max_per_ray * static_cast<double>(rays)), sums_(sources) {}

    /// Thread-safe.
    void add(std::size_t source, double found) { add_concurrently(sums_[source], unit_.from(found)); }
    std::span<std::int64_t> sums() { return {&sums_[0], sums_.capacity()}; }
    double sum(std::size_t source) const { return unit_.to_number(sums_[source]); }

  private:
    FixedPoint unit_;
    StableArray<std::int64_t> sums_;
};

}  // namespace interflect::detail
