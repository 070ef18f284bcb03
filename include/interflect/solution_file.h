#pragma once

#include <filesystem>
#include <string>

#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {
class StateArchive;
}  // namespace interflect::inline detail

namespace interflect {

/// A solved scene, complete for rendering.
struct SolvedScene {
    Scene scene;
    Solution solution;  ///< From a file: iterations lack their times; before version 5, all but the last are missing.
    int format_version = 0;          ///< Format version of the file read.
    std::string interflect_version;  ///< Program version that wrote the file; empty if not recorded.
};

/// Writes scene and solution as one HDF5 file (layout in docs/solution-file.md), with a report of every iteration and
/// checksums of every byte. Equal input gives equal bytes. Use with PendingFile.
/// @throws std::runtime_error if the file cannot be written; before writing, if the scene has a fault, or a quantity is
///         negative, not finite or not one per element. Every written file is therefore readable.
/// @param state  State of the run for continuation, see Solver::save(). Null: not stored.
void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                    const StateArchive* state = nullptr);

/// Reads files of write_solution() and of format versions 2 to 4.
/// @throws InputError for a file that is missing, damaged or of another kind.
SolvedScene read_solution(const std::filesystem::path& path);

/// Whether the file starts like a solution file of this or an older version; false if it cannot be read. True for a
/// current file with damaged first bytes.
bool is_solution_file(const std::filesystem::path& path);

}  // namespace interflect
