#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

namespace interflect::command {

// Each refuses options that were given but have no effect.

/// Refuses options of solving and of solutions, for path tracing. @throws UsageError
void refuse_solver_options(const CLI::App& command);
/// Refuses options of path tracing. @throws UsageError
void refuse_path_options(const CLI::App& command);
/// Refuses options of reading, dividing and solving a scene, for a solution. @throws InputError
/// @param traces_paths  Accepts --seed and --until, which path tracing uses.
void refuse_scene_options(const CLI::App& command, const std::filesystem::path& solution, bool traces_paths);

}  // namespace interflect::command
