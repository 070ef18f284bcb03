#pragma once

#include <cstdint>

namespace interflect::detail {

struct BounceRays {
    std::int64_t started = 0;
    std::int64_t expected = 0;  ///< Including later rays of random walks.
};

/// Distributes a pass over its bounces.
class BounceBudget {
  public:
    BounceBudget() = default;
    /// @param previous_total  total_unshot() of the previous pass; 0: unknown.
    BounceBudget(std::int64_t rays, double previous_total);

    /// @param unshot  Relative to the first bounce.
    BounceRays next(double unshot);
    bool has_planned_last_bounce() const { return is_last_ || left_ == 0; }
    /// Sum over bounces, relative to the first; the rest is a geometric series.
    double total_unshot() const { return unshot_sum_ + last_unshot_ * decay_ / (1 - decay_); }

  private:
    std::int64_t rays_ = 0, left_ = 0;
    double previous_total_ = 1;
    double last_unshot_ = 0, unshot_sum_ = 0, decay_ = 0;
    bool is_measured_ = false;  // previous_total_
    bool is_last_ = false;
};

}  // namespace interflect::detail
