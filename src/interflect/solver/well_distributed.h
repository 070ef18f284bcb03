#pragma once

#include <vector>

#include "interflect/solver/solver_state.h"

namespace interflect {

/// The rays of a run in which every ray is kept: all that were ever shot stand for the present estimate together, as a
/// well-distributed ray set (Neumann, Neumann and Bekaert 1997; with refinement, Bekaert et al. 1998). Leaf i has shot
/// n_i = N P_i / sum P rays, each of which carries the quantum sum P / N; when the estimate of P changes, or N grows,
/// an iteration shoots what each leaf lacks, and old hits count on with the new quantum. A leaf that has shot more than
/// its share shoots again when N has grown enough; until then N is a little larger than was planned, so that all rays
/// together carry sum P. The colour of a ray stays what it was when it was shot.
class WellDistributedRays {
  public:
    explicit WellDistributedRays(const SolverState& state);

    /// Grows N by plan.rays and takes the irradiance from all rays so far.
    /// @param plan  Its rays become those that were shot.
    /// @return The power that leaves the scene.
    RgbD iterate(SolverState& state, IterationPlan& plan);

  private:
    std::vector<double> shot_;  // rays of each leaf
    std::vector<Rgb> arrived_;  // quanta per area at each element, split to colours [1/m^2]
    RgbD escaped_{0, 0, 0};     // quanta that left the scene
    std::int64_t total_ = 0;    // N: rays of all leaves
};

}  // namespace interflect
