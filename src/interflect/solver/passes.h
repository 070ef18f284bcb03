#pragma once

#include <vector>

#include "interflect/solver/solver_state.h"

namespace interflect {

/// What one pass hands to the next.
struct PassState {
    /// Irradiance that was received and not shot when the last pass ended, as many rays as it had, by element: the next
    /// one shoots it too, so that the mean of all lacks nothing.
    std::vector<Rgb> unshot;
    double unshot_rays = 0;
    /// Sum over the bounces of the last pass of what was left to shoot, relative to its first bounce; 0: not known yet.
    /// Tells how many rays a bounce may have.
    double bounces = 0;
    bool is_final = false;  ///< The next pass is the last one.
};

/// One pass: shoots what the emitters emit, then what that brought, and so on, bounce by bounce, until little is left
/// ('incremental shooting', Neumann et al. 1995). Each bounce gets rays in proportion to what is left to shoot, weighed
/// as rays are (Eq. 3, 10). An unbiased estimate of all bounces on the mesh as it is, independent of earlier passes.
/// @param oracle_refines  Whether pairs are refined by Eq. 14, 15 on the way; else the mesh stays as it is.
/// @param escaped_power   Receives what left the scene [lm or W].
/// @return                Of every element.
FreshEstimate trace_pass(SolverState& state, PassState& passes, std::int64_t rays, bool oracle_refines,
                         RgbD& escaped_power);

/// Finds importance and, where the method refines, an initial mesh by Eq. 14 and 15, from two small passes. The light
/// of the second is the estimate until passes are merged, but none of it counts then.
/// @return The state that the first pass begins with.
PassState prepare_passes(SolverState& state);

/// A pass as an iteration: its estimate is merged with the mean of those before (Eq. 6), then the mesh is refined.
/// @param plan  Its rays become those that were traced.
/// @return      The power that left the scene.
RgbD iterate_pass(SolverState& state, PassState& passes, IterationPlan& plan);

/// A first estimate for iterations of another kind: as above, with a pass on the mesh that was made.
void make_first_estimate(SolverState& state);

}  // namespace interflect
