#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Histogram of ray power, in bins of a quarter of an octave.
class Quanta {
  public:
    /// @param power  Sum of the channels [lm or W].
    void add(double power, std::int64_t rays);
    Quanta& operator+=(const Quanta& other);

    double largest_over_mean() const;  ///< Returns 1 if no power was carried.
    /// Returns the power, relative to the mean, that a share of the rays exceeds; accurate to 19%.
    double quantile_over_mean(double share) const;

    void archive(StateArchive& archive) {
        archive("quanta/rays", rays_);
        archive("quanta/power", power_);
        archive("quanta/largest", largest_);
        archive("quanta/count", count_);
    }

  private:
    static constexpr int bins_per_octave = 4, middle_bin = 512, bins = 2 * middle_bin;
    std::vector<std::int64_t> rays_;  // by bin; empty before the first ray
    double power_ = 0, largest_ = 0;
    std::int64_t count_ = 0;
};

}  // namespace interflect::inline detail
