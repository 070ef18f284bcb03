#pragma once

#include <cstdint>

namespace interflect::detail {

/// Number of rays of a bounce.
struct BounceRays {
    std::int64_t started = 0;
    std::int64_t expected = 0;  ///< Number of rays, including the expected later rays of random walks.
};

/// Distributes the rays of a pass over its bounces.
class BounceBudget {
  public:
    BounceBudget() = default;
    /// @param previous_total   total_unshot() of the previous pass; 0: unknown.
    /// @param separates_first  Whether the first bounce must not be the last one, so that its light contains no light
    ///                         of random walks. This needs two rays, so a pass of one ray traces two.
    BounceBudget(std::int64_t rays, double previous_total, bool separates_first = false);

    /// Returns the rays of the next bounce. @param unshot  Unshot power, relative to that of the first bounce.
    BounceRays next(double unshot);
    bool has_planned_last_bounce() const { return is_last_ || left_ == 0; }
    /// Returns the sum of the unshot power over all bounces, relative to the first. Bounces that were not traced are
    /// estimated by a geometric series.
    double total_unshot() const { return unshot_sum_ + last_unshot_ * decay_ / (1 - decay_); }

  private:
    std::int64_t rays_ = 0, left_ = 0;
    double previous_total_ = 1;
    double last_unshot_ = 0, unshot_sum_ = 0, decay_ = 0;
    bool separates_first_ = false;
    bool is_measured_ = false;  // whether previous_total_ is measured
    bool is_last_ = false;
};

}  // namespace interflect::detail
