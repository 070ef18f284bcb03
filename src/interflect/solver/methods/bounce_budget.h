#pragma once

#include <cstdint>
#include <string>

#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Shares the rays of a pass among its bounces.
class BounceBudget {
  public:
    BounceBudget() = default;
    /// @param bounces   Sum over all bounces of what is left to shoot, relative to the first; 0: not known.
    /// @param is_final  No other pass will shoot what this one leaves.
    BounceBudget(std::int64_t rays, double bounces, bool is_final);

    /// @param unshot  What is left to shoot, relative to the first bounce.
    /// @return        The rays of the next bounce; all that are left if it is the last; 0 if there are none.
    std::int64_t next(double unshot);
    bool is_last() const { return is_last_ || left_ == 0; }
    /// Of this pass; what the bounces that it lacks would have to shoot is extrapolated.
    double bounces() const { return unshot_sum_ + last_unshot_ * decay_ / (1 - decay_); }

    void archive(StateArchive& archive, const std::string& name) {
        archive(name + "/rays", rays_);
        archive(name + "/left", left_);
        archive(name + "/bounces", bounces_);
        archive(name + "/fewest", fewest_);
        archive(name + "/least_left", least_left_);
        archive(name + "/last_unshot", last_unshot_);
        archive(name + "/unshot_sum", unshot_sum_);
        archive(name + "/decay", decay_);
        archive(name + "/is_last", is_last_);
    }

  private:
    std::int64_t rays_ = 0, left_ = 0;
    double bounces_ = 1, fewest_ = 1, least_left_ = 0;
    double last_unshot_ = 0, unshot_sum_ = 0, decay_ = 0;
    bool is_last_ = false;
};

}  // namespace interflect::inline detail
