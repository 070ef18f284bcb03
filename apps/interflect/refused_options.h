#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

namespace interflect::command {

// Each throws InputError for an option of `render` that was given and has no effect.

/// What path tracing does not take: options of solving, and of what only a solution has.
void refuse_solver_options(const CLI::App& command);
/// What only path tracing takes.
void refuse_path_options(const CLI::App& command);
/// Options of reading, dividing and solving a scene, where a solution is given. @param traces_paths  --shading path,
/// which has a seed and a target of its own.
void refuse_scene_options(const CLI::App& command, const std::filesystem::path& solution, bool traces_paths);

}  // namespace interflect::command
