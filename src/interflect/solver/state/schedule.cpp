#include "interflect/solver/state/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interflect/base/files/state_archive.h"

namespace interflect::detail {

namespace {

/// Rays of an iteration relative to the rays averaged before.
constexpr double growth = 0.5;
/// Largest number of rays of an iteration. It takes one or two seconds, so a run can stop soon.
constexpr std::int64_t largest_iteration = 1 << 24;
/// The first iteration has some rays per patch, but at most an eighth of the budget.
constexpr std::int64_t first_rays_per_patch = 4, fewest_first_rays = 50'000, budget_over_first_rays = 8;

}  // namespace

Schedule::Schedule(const SolveOptions& options, std::size_t patches) : options_(options) {
    const std::int64_t rays = std::max(fewest_first_rays, first_rays_per_patch * static_cast<std::int64_t>(patches));
    first_rays_ =
        std::min({rays, largest_iteration, std::max<std::int64_t>(1, options.limits.rays / budget_over_first_rays)});
    smallest_ = options.experimental.rays_per_iteration > 0 ? options.experimental.rays_per_iteration : first_rays_;
}

std::int64_t Schedule::start_rays(std::int64_t passes) const {
    constexpr std::int64_t rays_of_a_moment = 1 << 18;  // 1/64 of largest_iteration, which takes a second or two
    return std::min({smallest_, std::max(first_rays_, rays_of_a_moment),
                     std::max<std::int64_t>(1, options_.limits.rays / budget_over_first_rays / passes)});
}

void Schedule::record_start(std::int64_t averaged_rays, std::int64_t other_rays) {
    rays_ = averaged_rays + other_rays;
    averaged_rays_ = averaged_rays;
}

/// Returns the rays for the remaining time at the current speed; 0 if too few to be useful.
std::int64_t Schedule::affordable_rays(double seconds) {
    constexpr double share_of_time = 0.85;  // share of the remaining time; the rest is a margin for varying speed
    constexpr double min_share = 1.0 / 32;  // minimum size of a useful iteration, relative to the rays averaged before
    const double time_left = options_.limits.time - seconds, took = seconds - planned_at_;
    const std::int64_t traced = rays_ - planned_after_;
    planned_at_ = seconds;
    planned_after_ = rays_;
    if (time_left <= 0) return 0;
    if (traced == 0) return first_rays_;
    const double rays = share_of_time * time_left / took * static_cast<double>(traced);
    const bool is_worth_while = rays >= min_share * static_cast<double>(averaged_rays_);
    return is_worth_while ? std::llround(std::clamp(rays, 1.0, static_cast<double>(options_.limits.rays))) : 0;
}

bool Schedule::is_fulfilled() const {
    return is_over_ || rays_ >= options_.limits.rays ||
           (options_.experimental.iterations > 0 &&
            finished_ >= options_.experimental.warm_up + options_.experimental.iterations);
}

IterationPlan Schedule::next(double seconds) {
    const bool warming_up = finished_ < options_.experimental.warm_up;
    if (is_fulfilled()) return {};
    const std::int64_t left = options_.limits.rays - rays_;
    std::int64_t rays = smallest_;
    if (options_.experimental.rays_per_iteration == 0 && !warming_up)
        rays =
            std::clamp(static_cast<std::int64_t>(growth * static_cast<double>(averaged_rays_ - averaged_at_restart_)),
                       smallest_, largest_iteration);
    // An interruption would lose a long first iteration, so the first iteration is short.
    const bool counts_iterations = options_.experimental.iterations > 0 || options_.experimental.warm_up > 0;
    if (finished_ == 0 && rays > largest_iteration && !counts_iterations) rays = first_rays_;
    if (left < rays + rays / 2) rays = left;
    if (std::isfinite(options_.limits.time)) rays = std::min(rays, affordable_rays(seconds));
    if (rays <= 0) return {};
    return {.rays = rays, .warms_up = warming_up, .is_final = rays == left};
}

void Schedule::set_limits(const Limits& limits) {
    options_.limits = limits;
    is_over_ = false;
}

void Schedule::archive(StateArchive& archive) {
    archive("schedule/budget", options_.limits.rays);
    archive("schedule/first_rays", first_rays_);
    archive("schedule/smallest", smallest_);
    archive("schedule/rays", rays_);
    archive("schedule/averaged_rays", averaged_rays_);
    archive("schedule/averaged_at_restart", averaged_at_restart_);
    archive("schedule/finished", finished_);
    archive("schedule/is_over", is_over_);
    archive("schedule/planned_at", planned_at_);
    archive("schedule/planned_after", planned_after_);
    if (archive.reads()) require_consistent();
}

/// Checks restored numbers. With inconsistent numbers, a run may never end, or overflow.
void Schedule::require_consistent() const {
    constexpr std::int64_t most_rays = std::int64_t{1} << 62;
    const std::int64_t given = options_.experimental.rays_per_iteration;
    const auto require = StateArchive::require_range;
    require(options_.limits.rays > 0, "schedule/budget");
    require(first_rays_ > 0 && first_rays_ <= largest_iteration, "schedule/first_rays");
    require(smallest_ == (given > 0 ? given : first_rays_), "schedule/smallest");
    require(rays_ <= most_rays, "schedule/rays");
    require(averaged_rays_ <= rays_, "schedule/averaged_rays");
    require(averaged_at_restart_ <= rays_, "schedule/averaged_at_restart");
    require(planned_at_ >= 0, "schedule/planned_at");
    require(planned_after_ <= rays_, "schedule/planned_after");
}

void Schedule::done(const TracedIteration& iteration) {
    rays_ += iteration.rays;
    is_over_ = iteration.plan.is_final;
    const bool warming_up = finished_++ < options_.experimental.warm_up;
    averaged_rays_ = warming_up ? 0 : averaged_rays_ + iteration.rays;
}

}  // namespace interflect::detail
