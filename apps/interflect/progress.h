#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>

#include "interflect/solver/solve.h"

namespace interflect::command {

/// What Ctrl-C says where it ends an iteration: the first character is for a terminal, where a bar stands in the line.
inline constexpr std::string_view stop_after_iteration =
    "\nstopping after this iteration, keeping what there is; once more ends at once, keeping nothing\n";

/// Until the end of its scope, the first Ctrl-C (or SIGTERM) sets a flag, and says so, instead of ending the process;
/// the second ends it.
class StopOnInterrupt {
  public:
    /// @param notice  Like stop_after_iteration; of static lifetime.
    explicit StopOnInterrupt(std::string_view notice = stop_after_iteration);
    ~StopOnInterrupt();
    StopOnInterrupt(const StopOnInterrupt&) = delete;
    StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
    static const std::atomic<bool>& flag();
};

/// How far long work is.
struct WorkDone {
    double fraction = 0;  ///< In [0, 1].
    double seconds = 0;
    std::int64_t rays = 0;
    std::optional<double> error;  ///< Estimated relative error, if it has one; infinite where not known yet.
};

/// Shows it on stderr: one line that is written over on a terminal, else a line now and then.
class ProgressBar {
  public:
    ProgressBar();
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void show(const WorkDone& work);

  private:
    bool terminal_;
    double last_shown_ = -1e9;  // [s]
};

/// Share of the work that is done, by whichever limit comes first, in [0, 1].
double fraction_done(const SolveOptions& options, const IterationReport& report);

/// "3.5 s", "2 min 10 s", "1 h 5 min".
std::string duration(double seconds);
/// "950", "1.5 k", "20.0 M".
std::string magnitude(double number);

}  // namespace interflect::command
