#pragma once

#include <filesystem>
#include <string>

#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {
class StateArchive;
}  // namespace interflect::inline detail

namespace interflect {

/// A solved scene: all that is needed to draw it again.
struct SolvedScene {
    Scene scene;
    Solution solution;  ///< Read from a file: iterations lack their times; before version 5, those before the last.
    int format_version = 0;          ///< Of the file that it was read from.
    std::string interflect_version;  ///< What wrote that file; empty where it does not tell.
};

/// Writes scene and solution as one HDF5 file (layout in docs/solution-file.md): geometry, materials, views, the
/// elements with their irradiance and importance, how they were found in every iteration, and checksums of every byte.
/// The same input gives the same bytes, and what is written can be read. To be given a name by a PendingFile.
/// @throws std::runtime_error when the file cannot be written, or when the scene has a fault, or a quantity is negative
/// or not finite or has not one entry for every element: then nothing is written.
/// @param state  Of the run, so that it can go on: see Solver::save(). Null: the file has none.
void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                    const StateArchive* state = nullptr);

/// Reads what write_solution wrote, and files of the versions 2 to 4.
/// @throws InputError for a file that is missing, damaged or something else.
SolvedScene read_solution(const std::filesystem::path& path);

/// Whether the file at `path` begins like a solution file, of this version or an older one; false when it cannot be
/// read. True of a new one whose first bytes are damaged.
bool is_solution_file(const std::filesystem::path& path);

}  // namespace interflect
