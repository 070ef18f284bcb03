#pragma once

#include "apps/interflect/options/light_group_options.h"
#include "apps/interflect/options/shared_options.h"
#include "interflect/solution.h"

namespace interflect::command {

SolvedScene read_light_of(const std::filesystem::path& solution);

/// Reads and dims a solution, or reads a scene, without elements.
/// @throws InputError for an unreadable file.
SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming);

}  // namespace interflect::command
