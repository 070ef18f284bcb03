#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/solve_options.h"

namespace interflect::detail {

struct IterationPlan {
    std::int64_t rays = 0;           ///< Planned number of rays; 0: the run is over.
    bool warms_up = false;           ///< Whether the next iteration replaces this one instead of averaging.
    bool is_final = false;           ///< Whether this iteration ends the run, even if it traces fewer rays.
    std::uint32_t old_elements = 0;  ///< Number of elements before the iteration.
};

/// Result of an iteration besides its Estimate.
struct TracedIteration {
    const IterationPlan plan;
    std::int64_t rays = plan.rays;        ///< Number of traced rays, for any purpose.
    std::int64_t weight = plan.rays;      ///< Weight in the mean [rays].
    std::int64_t importance_rays = 0;     ///< Rays that carry importance alone.
    std::int64_t rays_for_new_views = 0;  ///< Additional rays after a change of views.
    /// Factor of each patch's history, from ViewChange::history_factor(); empty: 1.
    std::vector<float> history_factor = {};
};

/// Plans the number of rays of each iteration. Iteration m of N_m rays is averaged with tau = N_m / (N_1 + ... + N_m)
/// in Eq. 6, Prikryl et al. 2000.
class Schedule {
  public:
    Schedule(const SolveOptions& options, std::size_t patches);

    /// Returns the rays of each of `passes` passes before the first iteration: together at most an eighth of all rays.
    std::int64_t start_rays(std::int64_t passes = 1) const;
    /// Records the rays of these passes, of which `averaged_rays` are part of the first mean.
    void record_start(std::int64_t averaged_rays, std::int64_t other_rays);
    /// Plans the next iteration, within the time limit. @param seconds  Time since the run began [s].
    IterationPlan next(double seconds);
    bool is_fulfilled() const;
    void done(const TracedIteration& iteration);
    /// Resets the size of iterations to its minimum.
    void restart() { averaged_at_restart_ = averaged_rays_; }
    void count_other_rays(std::int64_t rays) { rays_ += rays; }

    /// Replaces the limits, without changing the size of the first iterations.
    void set_limits(const Limits& limits);
    void archive(StateArchive& archive);

    std::int64_t rays() const { return rays_; }
    std::int64_t averaged_rays() const { return averaged_rays_; }

  private:
    std::int64_t affordable_rays(double seconds);
    void require_consistent() const;

    SolveOptions options_;
    std::int64_t first_rays_;  // rays of the first iteration, unless a size is given
    std::int64_t smallest_;    // minimum or given size of an iteration [rays]
    std::int64_t rays_ = 0;
    std::int64_t averaged_rays_ = 0;
    std::int64_t averaged_at_restart_ = 0;  // averaged_rays_ at the last restart()
    int finished_ = 0;                      // number of finished iterations
    bool is_over_ = false;
    double planned_at_ = 0;           // time of the last plan since the run began [s]
    std::int64_t planned_after_ = 0;  // number of rays traced before the last plan
};

}  // namespace interflect::detail
