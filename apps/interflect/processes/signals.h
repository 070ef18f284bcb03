#pragma once

#include <atomic>

namespace interflect::command {

/// Must be called first. SIGINT (Ctrl-C), SIGTERM, SIGHUP and SIGUSR1 (forwarded by mpirun and Slurm) then remove
/// temporary files before they end the process; an ignored SIGHUP, as under nohup, stays ignored. Writing to a closed
/// pipe or beyond the limit of file sizes fails instead of ending the process.
void handle_signals();

/// From now on the first of these signals sets a flag and prints a message; the second ends the process. Call it before
/// work that can end early and whose results are then written.
void stop_on_signal();
const std::atomic<bool>& stop_flag();

/// Ignores these signals: another process decides when this one ends.
void ignore_stop_signals();

/// Reverts stop_on_signal(): the first signal ends the process.
void end_on_signal();

bool is_stop_requested();

}  // namespace interflect::command
