#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace interflect::command {

/// Refuses options that were given but have no effect.
/// @param refused   Names of options ("--show") and headings of the help, which stand for all options below them.
/// @param accepted  Names of exceptions.
/// @throws UsageError that names the option and the reason.
void refuse_options(const CLI::App& command, std::span<const std::string_view> refused, const std::string& reason,
                    std::span<const std::string_view> accepted = {});

// Each of the functions below calls refuse_options().

/// Refuses options of solving and of solutions, for path tracing.
void refuse_solver_options(const CLI::App& command);
/// Refuses options of path tracing.
void refuse_path_options(const CLI::App& command,
                         const std::string& reason = "only --shading hybrid, gather, path and instant take it");
/// Refuses options of reading, dividing and solving a scene, if `scene` is a solution.
/// @param traces_paths  Accepts --seed and --until, which path tracing uses.
void refuse_scene_options(const CLI::App& command, const std::filesystem::path& scene, bool traces_paths);

}  // namespace interflect::command
