#pragma once

#include <cstdint>

#include "interflect/solve.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Plan of the next iteration.
struct IterationPlan {
    std::int64_t rays = 0;  ///< 0: the run is over.
    bool warms_up = false;  ///< Not averaged: the next iteration replaces it.
    bool is_final = false;  ///< Ends the run, even if it traces fewer rays.
};

/// Ray counts of the iterations. Iterations are averaged with tau = N_m / (N_1 + ... + N_m) in Eq. 6, Prikryl et al.
/// 2000; equal counts give the paper's 1/m. Unless their size is given, iterations grow with the rays averaged before.
/// So early ones, without late bounces and a fine mesh, soon have little weight. A given size above 2^24 applies from
/// the second iteration on, unless the number of iterations is given too.
class Schedule {
  public:
    Schedule(const SolveOptions& options, std::size_t patches);

    /// Rays of each pass before the first iteration: at least one, at most an eighth of all, and few even if iterations
    /// are long.
    std::int64_t start_rays() const;
    /// Records these passes. Rays with power are the first term of the average.
    void began_with(std::int64_t power_rays, std::int64_t other_rays);
    /// Plans the next iteration. It should end within a time limit, because an interrupted iteration is lost.
    /// @param seconds  Since the run began.
    IterationPlan next(double seconds);
    bool is_fulfilled() const;
    void done(const IterationPlan& plan);
    /// Makes iterations small again; they grow with the rays averaged from now on.
    void restart() { averaged_at_restart_ = averaged_rays_; }
    void count_other_rays(std::int64_t rays) { rays_ += rays; }

    /// Replaces SolveOptions::limits. The size of the first iterations does not change.
    void set_limits(const Limits& limits);
    void archive(StateArchive& archive);

    std::int64_t rays() const { return rays_; }
    std::int64_t averaged_rays() const { return averaged_rays_; }

  private:
    std::int64_t affordable_rays(double seconds);

    SolveOptions options_;
    std::int64_t first_rays_;  // of the first iteration, unless a size is given
    std::int64_t smallest_;    // size of an iteration [rays]
    std::int64_t rays_ = 0;
    std::int64_t averaged_rays_ = 0;
    std::int64_t averaged_at_restart_ = 0;
    int finished_ = 0;  // number of finished iterations
    bool is_over_ = false;
    double planned_at_ = 0;           // of the last iteration [s]
    std::int64_t planned_after_ = 0;  // rays traced before it
};

}  // namespace interflect::inline detail
