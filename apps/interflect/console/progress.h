#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace interflect::command {

struct WorkDone {
    double fraction = 0;  ///< Share of the work that is done, from 0 to 1.
    double seconds = 0;
    std::int64_t rays = 0;
    std::optional<double> error;  ///< Estimated relative error of work that has one; infinite while it is unknown.
};

/// Overwrites a line on a terminal. Elsewhere, prints a line every two seconds, and the last one.
class ProgressBar {
  public:
    ProgressBar();
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void show(const WorkDone& work);

  private:
    /// Returns the remaining time at the speed since the first report. The time before it does not count, because work
    /// was prepared.
    std::string time_left(const WorkDone& work);

    bool terminal_;
    std::optional<WorkDone> first_;
    double last_shown_ = -1e9;  // [s]
    std::string not_shown_;     // latest line that was not printed
};

/// Returns whether lines of stderr can be overwritten.
bool stderr_is_terminal();
/// Prints to stderr and flushes it. Ignores errors.
void print_progress(const std::string& text);

/// Returns text such as "3.5 s", "2 min 10 s" and "1 h 5 min".
std::string duration(double seconds);
/// Returns text such as "950", "1.5 k" and "20.0 M".
std::string magnitude(double number);

}  // namespace interflect::command
