#pragma once

#include <filesystem>

#include "interflect/scene/scene.h"
#include "interflect/solver/solve.h"

namespace interflect {

/// A solved scene: all that is needed to draw it again.
struct SolvedScene {
    Scene scene;
    Solution solution;
};

/// Writes scene and solution as one HDF5 file (layout in docs/solution-file.md): geometry, materials, views, the
/// elements with their irradiance and importance, and how they were found. The same input gives the same bytes. To be
/// given a name by a PendingFile.
/// @throws std::runtime_error when the file cannot be written.
void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution);

/// Reads what write_solution wrote. @throws InputError for a file that is missing, damaged or something else.
SolvedScene read_solution(const std::filesystem::path& path);

/// Whether the file at `path` begins like an HDF5 file; false when it cannot be read.
bool is_solution_file(const std::filesystem::path& path);

}  // namespace interflect
