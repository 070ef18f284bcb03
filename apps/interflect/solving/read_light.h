#pragma once

#include "apps/interflect/options/light_group_options.h"
#include "apps/interflect/options/shared_options.h"
#include "interflect/solution.h"

namespace interflect::command {

/// Reads a solution. @throws InputError for another kind of file.
SolvedScene read_light_of(const std::filesystem::path& solution);

/// Reads and dims a solution, or reads a scene, whose solution is then empty.
/// @throws InputError for an unreadable file.
SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming);

}  // namespace interflect::command
