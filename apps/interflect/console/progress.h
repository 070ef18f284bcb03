#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace interflect::command {

struct WorkDone {
    double fraction = 0;  ///< In [0, 1].
    double seconds = 0;
    std::int64_t rays = 0;
    std::optional<double> error;  ///< Estimated relative error, if any; infinite while unknown.
};

/// Overwrites a line on a terminal; otherwise prints occasional lines and the last.
class ProgressBar {
  public:
    ProgressBar();
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void show(const WorkDone& work);

  private:
    /// From the speed since the first report: before it, work was prepared.
    std::string time_left(const WorkDone& work);

    bool terminal_;
    std::optional<WorkDone> first_;
    double last_shown_ = -1e9;  // [s]
    std::string not_shown_;     // a later line
};

/// Returns whether lines of stderr can be overwritten.
bool stderr_is_terminal();
/// Flushes stderr; ignores errors.
void print_progress(const std::string& text);

/// "3.5 s", "2 min 10 s", "1 h 5 min".
std::string duration(double seconds);
/// "950", "1.5 k", "20.0 M".
std::string magnitude(double number);

}  // namespace interflect::command
