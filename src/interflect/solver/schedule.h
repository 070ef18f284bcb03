#pragma once

#include <cstdint>

#include "interflect/solve.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Plan of the next iteration.
struct IterationPlan {
    std::int64_t rays = 0;  ///< 0: the run is over.
    bool warms_up = false;  ///< Not averaged: the next iteration replaces it.
    bool is_final = false;  ///< Has all remaining rays and ends the run, even if it traces fewer.
};

/// Ray counts of the iterations. The weight of an iteration is its ray count, tau = N_m / (N_1 + ... + N_m) in Eq. 6,
/// Prikryl et al. 2000; equal counts give the paper's 1/m. Without a fixed size, iterations grow with the rays averaged
/// before. So early iterations, which lack late bounces and a fine mesh, soon have little weight. A fixed size above
/// 2^24 rays applies from the second iteration on, unless a number of iterations is given.
class Schedule {
  public:
    Schedule(const SolveOptions& options, std::size_t patches);

    /// Rays of each pass before the first iteration: at least one, at most an eighth of all, and few enough to take a
    /// short time for any size of iterations.
    std::int64_t start_rays() const;
    /// Records the rays of these passes. Rays that carried power are the first term of the average.
    void began_with(std::int64_t power_rays, std::int64_t other_rays);
    /// Plans the next iteration. With a time limit it should end in time, because an interrupted iteration is lost.
    /// @param seconds  Since the run began.
    IterationPlan next(double seconds);
    /// Whether the run is complete, even if time remains.
    bool is_fulfilled() const;
    void done(const IterationPlan& plan);
    /// Makes the next iterations small; they grow with the rays averaged from now on.
    void restart() { averaged_at_restart_ = averaged_rays_; }
    /// Adds rays that are not averaged.
    void count_other_rays(std::int64_t rays) { rays_ += rays; }

    /// Replaces SolveOptions::limits. The size of the first iterations, derived from the old limits, does not change.
    void set_limits(const Limits& limits);
    void archive(StateArchive& archive);

    std::int64_t rays() const { return rays_; }
    std::int64_t averaged_rays() const { return averaged_rays_; }

  private:
    std::int64_t affordable_rays(double seconds);

    SolveOptions options_;
    std::int64_t first_rays_;         // of the first iteration, unless a size is given
    std::int64_t smallest_;           // iteration size [rays]
    std::int64_t rays_ = 0;           // traced so far
    std::int64_t averaged_rays_ = 0;  // rays in the running mean
    std::int64_t averaged_at_restart_ = 0;
    int finished_ = 0;                // number of finished iterations
    bool is_over_ = false;            // the final iteration is done
    double planned_at_ = 0;           // time at which the last iteration was planned [s]
    std::int64_t planned_after_ = 0;  // rays traced before that
};

}  // namespace interflect::inline detail
