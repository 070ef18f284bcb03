#pragma once

#include "apps/interflect/shared_options.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/scene/scene.h"

namespace interflect::command {

/// Solves with progress on stderr, Ctrl-C heeded and statistics written: what `solve` and `render` share.
/// @param options  command.resolved().
Solution run_solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                   const SolverOptions& command);

}  // namespace interflect::command
