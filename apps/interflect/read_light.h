#pragma once

#include <CLI/CLI.hpp>

#include "apps/interflect/light_group_options.h"
#include "apps/interflect/shared_options.h"
#include "interflect/solution_file.h"

namespace interflect::command {

/// Reads a solution, reported by LongWork.
SolvedScene read_light_of(const std::filesystem::path& solution);

/// Reads a solution, dimmed as asked for, or a scene that is not solved yet: then without elements.
/// @param command       Whose options are refused where they have no effect on a solution.
/// @param traces_paths  Whether rays are traced after solving, so that a seed and a target have one all the same.
/// @throws InputError for a file that cannot be read, and for options that have no effect.
SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming, const CLI::App& command,
                                   bool traces_paths);

}  // namespace interflect::command
