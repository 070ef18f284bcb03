#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/solve_options.h"

namespace interflect::detail {

struct IterationPlan {
    std::int64_t rays = 0;           ///< 0: the run is over.
    bool warms_up = false;           ///< Not averaged: the next iteration replaces it.
    bool is_final = false;           ///< Ends the run, even with fewer traced rays.
    std::uint32_t old_elements = 0;  ///< Before the iteration.
};

/// Result of an iteration besides its Estimate.
struct TracedIteration {
    const IterationPlan plan;
    std::int64_t rays = plan.rays;        ///< Traced, for any purpose.
    std::int64_t weight = plan.rays;      ///< Weight in the mean [rays].
    std::int64_t importance_rays = 0;     ///< Rays that carry importance alone.
    std::int64_t rays_for_new_views = 0;  ///< Additional rays after a change of views.
    /// ViewChange::history_factor(); empty: 1.
    std::vector<float> history_factor = {};
};

/// Ray counts, averaged with tau = N_m / (N_1 + ... + N_m) in Eq. 6, Prikryl et al. 2000.
class Schedule {
  public:
    Schedule(const SolveOptions& options, std::size_t patches);

    /// Returns the rays of each of `passes` passes before the first iteration: together at most an eighth of all.
    std::int64_t start_rays(std::int64_t passes = 1) const;
    /// Records these passes; `averaged_rays` are in the first mean.
    void record_start(std::int64_t averaged_rays, std::int64_t other_rays);
    /// Respects the time limit. @param seconds  Since the run began.
    IterationPlan next(double seconds);
    bool is_fulfilled() const;
    void done(const TracedIteration& iteration);
    /// Makes iterations small again.
    void restart() { averaged_at_restart_ = averaged_rays_; }
    void count_other_rays(std::int64_t rays) { rays_ += rays; }

    /// Keeps the size of the first iterations.
    void set_limits(const Limits& limits);
    void archive(StateArchive& archive);

    std::int64_t rays() const { return rays_; }
    std::int64_t averaged_rays() const { return averaged_rays_; }

  private:
    std::int64_t affordable_rays(double seconds);
    void require_consistent() const;

    SolveOptions options_;
    std::int64_t first_rays_;  // unless a size is given
    std::int64_t smallest_;    // minimum or given size of an iteration [rays]
    std::int64_t rays_ = 0;
    std::int64_t averaged_rays_ = 0;
    std::int64_t averaged_at_restart_ = 0;
    int finished_ = 0;
    bool is_over_ = false;
    double planned_at_ = 0;           // [s]
    std::int64_t planned_after_ = 0;  // rays traced before it
};

}  // namespace interflect::detail
