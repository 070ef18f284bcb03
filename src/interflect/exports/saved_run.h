#pragma once

#include <filesystem>

#include "interflect/base/state_archive.h"
#include "interflect/solution.h"

namespace interflect::detail {

struct SavedRun {
    SolvedScene solved;  ///< Sources are undimmed; apply Solution::dimming.
    StateArchive state;  ///< Open for reading.
};

/// Opens and verifies a file with state once. @throws InputError as read_solution(), and if the state is missing or
/// from another version of Interflect.
SavedRun read_saved_run(const std::filesystem::path& path);

/// Writes a solution file with the state of its run, for read_saved_run(). @param state  Null: without. @throws as
/// the public write_solution().
void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                    const StateArchive* state);

}  // namespace interflect::detail
