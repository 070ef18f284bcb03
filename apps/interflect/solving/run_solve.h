#pragma once

#include <functional>
#include <optional>

#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/solving/checkpoints.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solver.h"

namespace interflect::command {

/// Warns about emitters covered by coincident faces, with the missing power.
void warn_of_covered_emission(const Scene& scene, const RayCaster& ray_caster);

/// Use of the light so far, during a run.
struct EarlyLight {
    double after = 0;      ///< Time of the run before the first use [s].
    bool repeats = false;  ///< Whether the light is used again, whenever the time of the run has doubled.
    /// May return a new SolveOptions::limits.
    std::function<std::optional<Limits>(const Solution&)> use = {};
};

/// Solves with progress on stderr; Ctrl-C ends it early with a usable result.
/// @param asked_for  SolverOptions::resolved(). @param memory  SolverOptions::memory.
Solution run_solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& asked_for, std::size_t memory,
                   Checkpoints checkpoints = {}, const EarlyLight& early_light = {});

/// Continues a run to its end, as run_solve() does.
Solution run_to_end(Solver solver, Checkpoints checkpoints, const EarlyLight& early_light = {});

}  // namespace interflect::command
