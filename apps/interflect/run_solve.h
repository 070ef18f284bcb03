#pragma once

#include "apps/interflect/checkpoints.h"
#include "apps/interflect/shared_options.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solver.h"

namespace interflect::command {

/// Warns about emitters covered by coincident faces, with the missing power.
void warn_of_covered_emission(const Scene& scene, const RayCaster& ray_caster);

/// Solves with progress on stderr; Ctrl-C ends it early with a usable result.
/// @param asked_for  SolverOptions::resolved(). @param memory  SolverOptions::memory.
Solution run_solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& asked_for, std::size_t memory,
                   const Checkpoints& checkpoints = {});

/// Continues a run in the same way.
Solution run_to_end(Solver solver, const Checkpoints& checkpoints);

}  // namespace interflect::command
