#pragma once

#include <CLI/CLI.hpp>

#include "apps/interflect/light_group_options.h"
#include "apps/interflect/shared_options.h"
#include "interflect/solution_file.h"

namespace interflect::command {

SolvedScene read_light_of(const std::filesystem::path& solution);

/// Reads and dims a solution, or reads a scene, without elements.
/// @param command       Its options are refused if they have no effect on a solution.
/// @param traces_paths  Accepts --seed and --until, since rays are traced after solving.
/// @throws InputError for an unreadable file and for options without effect.
SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming, const CLI::App& command,
                                   bool traces_paths);

}  // namespace interflect::command
