#pragma once

#include <filesystem>

#include "interflect/solution_file.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// A run that can resume.
struct SavedRun {
    SolvedScene solved;  ///< The sources of its scene are not dimmed; apply Solution::dimming.
    StateArchive state;  ///< Open for reading.
};

/// Reads a file that write_solution() wrote with a state; opens and verifies it once.
/// @throws InputError as read_solution(), and if the state is missing or from another version of Interflect.
SavedRun read_saved_run(const std::filesystem::path& path);

}  // namespace interflect::inline detail
