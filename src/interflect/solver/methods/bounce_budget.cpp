#include "interflect/solver/methods/bounce_budget.h"

#include <algorithm>
#include <cmath>

namespace interflect::inline detail {

namespace {

/// A pass ends when the next bounce would get fewer rays; the next pass shoots what is left.
constexpr double fewest_rays_of_bounce = 16;
/// Or when what is left, with all its bounces, is less than this share of the pass: every bounce takes time for every
/// element.
constexpr double least_share_left = 0.05;
/// Before a pass has told: the sum over all bounces of what is left to shoot, relative to the first.
constexpr double assumed_bounces = 2;
/// What is left to shoot is expected to fall by such factors from one bounce to the next: before it is known; where it
/// has just grown, as it may while light spreads towards the view; and at most.
constexpr double decay_at_first = 0.1, decay_while_it_grows = 0.9, highest_decay = 0.99;

}  // namespace

BounceBudget::BounceBudget(std::int64_t rays, double bounces, bool is_final)
    : rays_(rays),
      left_(rays),
      bounces_(bounces > 0 ? bounces : assumed_bounces),
      fewest_(is_final ? 1 : fewest_rays_of_bounce),
      least_left_(is_final ? 0 : least_share_left * bounces_) {}

std::int64_t BounceBudget::next(double unshot) {
    const double left = static_cast<double>(left_), all = static_cast<double>(rays_);
    // If all bounces to come decay alike, they must do with what is left.
    const double fall = last_unshot_ > 0 ? unshot / last_unshot_ : decay_at_first;
    decay_ = fall < 1 ? std::min(highest_decay, fall) : decay_while_it_grows;
    last_unshot_ = unshot;
    const double share = all * unshot / bounces_;
    is_last_ = share < fewest_ || left < fewest_ || unshot < (1 - fall) * least_left_;
    const double rays = is_last_ ? left : std::min(share, std::max(1.0, (1 - decay_) * left));
    const std::int64_t taken = std::min<std::int64_t>(left_, std::llround(rays));
    left_ -= taken;
    unshot_sum_ += unshot;
    return taken;
}

}  // namespace interflect::inline detail
