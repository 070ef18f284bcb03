#pragma once

#include "apps/interflect/checkpoints.h"
#include "apps/interflect/shared_options.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solver.h"

namespace interflect::command {

/// Logs how much of the light is not emitted since other faces coincide with its emitters, where there is any.
void warn_of_covered_emission(const Scene& scene, const RayCaster& ray_caster);

/// Solves with progress on stderr and Ctrl-C heeded: what `solve` and `render` share.
/// @param asked_for  SolverOptions::resolved().
/// @param memory     SolverOptions::memory.
Solution run_solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& asked_for, std::size_t memory,
                   const Checkpoints& checkpoints = {});

/// Goes on with a run to its end, likewise.
Solution run_to_end(Solver solver, const Checkpoints& checkpoints);

}  // namespace interflect::command
