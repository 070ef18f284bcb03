#pragma once

#include <cstdint>

namespace interflect::detail {

/// Rays of one bounce of a pass.
struct BounceRays {
    std::int64_t started = 0;   ///< Rays to start.
    std::int64_t expected = 0;  ///< Expected number of traced rays, including random walks.
};

/// Distribution of the rays of a pass over its bounces.
class BounceBudget {
  public:
    BounceBudget() = default;
    /// @param bounces Expected unshot power, summed over all bounces, relative to the first bounce; 0: unknown.
    BounceBudget(std::int64_t rays, double bounces);

    /// @param unshot Unshot power, relative to the first bounce.
    /// @return        The rays of the next bounce. Random walks complete the last bounce.
    BounceRays next(double unshot);
    bool is_last() const { return is_last_ || left_ == 0; }
    /// Returns the unshot power, summed over the bounces of this pass, relative to the first. Omitted bounces are
    /// extrapolated as a geometric series.
    double bounces() const { return unshot_sum_ + last_unshot_ * decay_ / (1 - decay_); }

  private:
    std::int64_t rays_ = 0, left_ = 0;
    double bounces_ = 1;
    double last_unshot_ = 0, unshot_sum_ = 0, decay_ = 0;
    bool is_known_ = false;  // bounces_, from the previous pass
    bool is_last_ = false;
};

}  // namespace interflect::detail
