#pragma once

#include <cstdint>

#include "interflect/solve.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// One iteration to come.
struct IterationPlan {
    std::int64_t rays = 0;  ///< 0: the run is over.
    bool warms_up = false;  ///< It is not averaged: the next one takes its place.
    bool is_final = false;  ///< It has all rays that are left, and the run ends with it, even if light runs out first.
};

/// How many rays the next iteration gets. Iterations are averaged by their ray counts, tau = N_m / (N_1 + ... + N_m) in
/// Eq. 6, which is the paper's 1/m when all have the same; without a fixed size they grow with what was averaged
/// before, so that early iterations, which still lack late bounces and a fine mesh, soon weigh little. A size beyond
/// 2^24 rays holds from the second iteration on, unless their number is asked for.
class Schedule {
  public:
    Schedule(const SolveOptions& options, std::size_t patches);

    /// Rays of each pass before the first iteration: no more than an eighth of all, but one; nor more than take a
    /// moment, whatever the size of an iteration.
    std::int64_t start_rays() const;
    /// Enters the rays of those passes; those that carried power are the first term of the average.
    void began_with(std::int64_t power_rays, std::int64_t other_rays);
    /// With a limit of time an iteration is planned to end before it, since one that does not is lost.
    /// @param seconds  Since the run began.
    IterationPlan next(double seconds);
    /// Whether there is no next one, however much time is left.
    bool is_fulfilled() const;
    void done(const IterationPlan& plan);
    /// Iterations begin small again, and grow with what is averaged from now on.
    void restart() { averaged_at_restart_ = averaged_rays_; }
    /// Enters rays that are averaged with none.
    void count_other_rays(std::int64_t rays) { rays_ += rays; }

    /// Replaces SolveOptions::limits; what they made of the first iterations stays.
    void set_limits(const Limits& limits);
    void archive(StateArchive& archive);

    std::int64_t rays() const { return rays_; }
    std::int64_t averaged_rays() const { return averaged_rays_; }

  private:
    std::int64_t affordable_rays(double seconds);

    SolveOptions options_;
    std::int64_t first_rays_;         // of the first iteration, unless its size was asked for
    std::int64_t smallest_;           // iteration [rays]
    std::int64_t rays_ = 0;           // traced so far
    std::int64_t averaged_rays_ = 0;  // of them in the running mean
    std::int64_t averaged_at_restart_ = 0;
    int finished_ = 0;                // iterations
    bool is_over_ = false;            // the final one is done
    double planned_at_ = 0;           // when the last iteration was planned [s],
    std::int64_t planned_after_ = 0;  // and after how many rays
};

}  // namespace interflect::inline detail
