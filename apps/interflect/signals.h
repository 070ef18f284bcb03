#pragma once

#include <atomic>

namespace interflect::command {

/// To be called first of all. From then on SIGINT (Ctrl-C), SIGTERM and SIGHUP, unless it is ignored as under nohup,
/// remove temporary files before they end the process; writing to a closed pipe, or more than a file may hold, fails
/// instead of ending it.
void handle_signals();

/// From now on the first of SIGINT, SIGTERM and SIGHUP sets a flag, and says so; only the second ends the process. To
/// be called before work that can be ended early, and then holds for the writing of its results too.
void stop_on_signal();
const std::atomic<bool>& stop_flag();

/// From now on the first signal ends the process again.
void end_on_signal();

/// Whether the flag is set.
bool is_stop_requested();

}  // namespace interflect::command
