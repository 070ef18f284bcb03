#pragma once

#include <exception>
#include <filesystem>
#include <string>

namespace interflect::command {

/// Returns the message of an exception, with remedies if memory was exhausted.
std::string explanation(const std::exception& error);

/// Sets the file from which a run could go on after a fault; empty: none.
void set_last_checkpoint(const std::filesystem::path& file);

/// Writes to stderr, from any thread, why several processes end, and how to go on from the last checkpoint.
/// @param fault  A sentence without a full stop.
void report_fault(const std::string& fault);

/// Returns "process 2 on node7", for faults of this process.
std::string name_of_process(int rank);

}  // namespace interflect::command
