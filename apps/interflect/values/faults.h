#pragma once

#include <exception>
#include <filesystem>
#include <string>

namespace interflect::command {

/// Returns the message of an exception. Adds the option that would allow the input, or remedies for exhausted memory.
std::string explanation(const std::exception& error);

/// Sets the last checkpoint of the run, for report_fault(); empty: no checkpoint.
void set_last_checkpoint(const std::filesystem::path& file);

/// Writes to stderr why the processes end, and the command that resumes the last checkpoint. Thread-safe.
/// @param fault  A sentence without a full stop.
void report_fault(const std::string& fault);

/// Returns "process 2 on node7", for faults of this process.
std::string name_of_process(int rank);

}  // namespace interflect::command
