#include "interflect/solver/methods/bounce_budget.h"

#include <algorithm>
#include <cmath>

namespace interflect::detail {

namespace {

/// Random walks replace the remaining bounces if the next bounce would have fewer rays.
constexpr double fewest_rays_of_bounce = 2;
/// Random walks also replace the remaining bounces below this share of a pass, because each bounce takes time for every
/// element.
constexpr double min_share_left = 0.05;
/// Minimum number of random walks. Fewer make small passes noisy. Their rays beyond the planned number are not counted.
constexpr std::int64_t fewest_walks = 32;
/// Value of total_unshot() before the first pass has measured it.
constexpr double assumed_bounces = 2;
/// Expected ratio of the unshot power of successive bounces: after the first bounce, after an increase, and the
/// maximum.
constexpr double decay_at_first = 0.1, decay_while_it_grows = 0.9, highest_decay = 0.99;

}  // namespace

BounceBudget::BounceBudget(std::int64_t rays, double previous_total, bool separates_first)
    : rays_(separates_first ? std::max<std::int64_t>(2, rays) : rays),
      left_(rays_),
      previous_total_(previous_total > 0 ? previous_total : assumed_bounces),
      separates_first_(separates_first),
      is_measured_(previous_total > 0) {}

BounceRays BounceBudget::next(double unshot) {
    const double left = static_cast<double>(left_);
    const double ratio = last_unshot_ > 0 ? unshot / last_unshot_ : decay_at_first;
    decay_ = ratio < 1 ? std::min(highest_decay, ratio) : decay_while_it_grows;
    last_unshot_ = unshot;
    // The unshot power of this and later bounces is predicted from the previous pass, or else as a geometric series.
    const double geometric = unshot / (1 - decay_), planned = is_measured_ ? previous_total_ - unshot_sum_ : geometric;
    // Later bounces keep at least a tenth of the rays, for light that the previous pass missed.
    const double to_come = is_measured_ ? std::max(planned, unshot / (1 - decay_at_first)) : geometric;
    const double share = std::min(left * unshot / to_come, static_cast<double>(rays_) * unshot / previous_total_);
    const double to_walk = std::max(planned, geometric);
    const bool is_separate = separates_first_ && unshot_sum_ == 0;
    is_last_ = !is_separate &&
               (share < fewest_rays_of_bounce || share + 1 > left || to_walk < min_share_left * previous_total_);
    const double starting = is_last_ ? left * unshot / to_walk : share;  // a walk has to_walk / unshot rays
    const std::int64_t fewest = is_last_ ? fewest_walks : 1;
    std::int64_t started = std::max<std::int64_t>(fewest, std::llround(starting));
    if (is_separate) started = std::min(started, left_ - 1);  // the other bounces need a ray
    const std::int64_t expected = is_last_ ? left_ : started;
    left_ -= expected;
    unshot_sum_ += unshot;
    return {started, expected};
}

}  // namespace interflect::detail
