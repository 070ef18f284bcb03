#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/memory/stable_array.h"
#include "interflect/base/numbers/fixed_point.h"

namespace interflect::detail {

/// Importance at hit points, summed by source. The mean over a leaf's rays estimates its transported importance (Eq. 7,
/// Prikryl et al. 2000).
class FoundImportance {
  public:
    FoundImportance(double max_per_ray, std::int64_t rays, std::size_t sources)
        : unit_(max_per_ray * static_cast<double>(rays)), sums_(sources) {}

    /// Thread-safe.
    void add(std::size_t source, double found) { add_concurrently(sums_[source], unit_.from(found)); }
    double sum(std::size_t source) const { return unit_.to_number(sums_[source]); }

    // For add_over_ranks():
    std::size_t size() const { return sums_.capacity(); }
    static std::size_t terms() { return 1; }
    bool is_zero(std::size_t source) const { return sums_[source] == 0; }
    void read(std::size_t source, std::span<std::int64_t> sum) const { sum[0] = sums_[source]; }
    void take(std::size_t source, std::span<std::int64_t> sum) { sum[0] = std::exchange(sums_[source], 0); }
    void add(std::size_t source, std::span<const std::int64_t> sum) { sums_[source] += sum[0]; }

  private:
    FixedPoint unit_;
    StableArray<std::int64_t> sums_;
};

}  // namespace interflect::detail
