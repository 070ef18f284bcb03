#include "interflect/solver/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace interflect {

namespace {

/// An iteration has this many times the rays averaged before it.
constexpr double growth = 0.5;
/// Most rays of an iteration: a second or two, so that the end of an iteration is never far.
constexpr std::int64_t largest_iteration = 1 << 24;
/// Rays of the first iteration: some for every patch, but never more than a small part of the budget.
constexpr std::int64_t first_rays_per_patch = 4, fewest_first_rays = 50'000, budget_over_first_rays = 8;

}  // namespace

Schedule::Schedule(const SolveOptions& options, std::size_t patches) : options_(options) {
    smallest_ = options.rays_per_iteration;
    if (smallest_ > 0) return;
    smallest_ = std::max(fewest_first_rays, first_rays_per_patch * static_cast<std::int64_t>(patches));
    smallest_ =
        std::min({smallest_, largest_iteration, std::max<std::int64_t>(1, options.rays / budget_over_first_rays)});
}

std::int64_t Schedule::start_rays() const {
    return std::min(smallest_, std::max<std::int64_t>(1, options_.rays / budget_over_first_rays));
}

void Schedule::began_with(std::int64_t power_rays, std::int64_t other_rays) {
    rays_ = power_rays + other_rays;
    averaged_rays_ = power_rays;
}

IterationPlan Schedule::next(double seconds) const {
    const bool warming_up = finished_ < options_.warm_up;
    if (is_over_) return {};
    if (options_.iterations > 0 && finished_ >= options_.warm_up + options_.iterations) return {};
    const std::int64_t left = options_.rays - rays_;
    std::int64_t rays = smallest_;
    if (options_.rays_per_iteration == 0 && !warming_up)
        rays = std::clamp(static_cast<std::int64_t>(growth * static_cast<double>(averaged_rays_)), smallest_,
                          largest_iteration);
    if (std::isfinite(options_.seconds)) {
        const double time_left = options_.seconds - seconds;
        if (time_left <= 0) return {};
        if (rays_ > 0) {
            const double affordable = time_left / seconds * static_cast<double>(rays_);
            rays = std::min(rays, std::max<std::int64_t>(1, static_cast<std::int64_t>(affordable)));
        }
    }
    // What would remain for a last iteration of less than half the size goes into this one.
    if (left < rays + rays / 2) rays = left;
    if (rays <= 0) return {};
    return {rays, warming_up, rays == left};
}

void Schedule::done(const IterationPlan& plan) {
    rays_ += plan.rays;
    is_over_ = plan.is_final;
    const bool warming_up = finished_++ < options_.warm_up;
    averaged_rays_ = warming_up ? 0 : averaged_rays_ + plan.rays;
}

}  // namespace interflect
