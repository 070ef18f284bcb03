#pragma once

#include <filesystem>

#include "interflect/solution_file.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

struct SavedRun {
    SolvedScene solved;  ///< Sources are undimmed; apply Solution::dimming.
    StateArchive state;  ///< Open for reading.
};

/// Opens and verifies a file with state once. @throws InputError as read_solution(), and if the state is missing or
/// from another version of Interflect.
SavedRun read_saved_run(const std::filesystem::path& path);

}  // namespace interflect::inline detail
