#pragma once

#include <filesystem>

#include "interflect/solution_file.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// A run that can go on.
struct SavedRun {
    SolvedScene solved;  ///< The sources of its scene are not dimmed; Solution::dimming says which should be.
    StateArchive state;  ///< For reading.
};

/// Reads what write_solution() wrote with a state: opens and verifies the file once. @throws InputError where it has no
/// state, or one of another version of Interflect, and as read_solution().
SavedRun read_saved_run(const std::filesystem::path& path);

}  // namespace interflect::inline detail
