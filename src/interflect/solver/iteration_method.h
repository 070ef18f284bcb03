#pragma once

#include "interflect/solver/solver_state.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// How one family of methods does its iterations, with the state that is its own. What throws Interrupted may be called
/// again, and goes on with the step of rays that was cut short.
class IterationMethod {
  public:
    virtual ~IterationMethod() = default;

    /// What comes before the first iteration. @throws Interrupted
    virtual void prepare(SolverState&) {}
    /// Whether all is done that the options ask for.
    virtual bool is_fulfilled(const SolverState& state) const { return state.schedule.is_fulfilled(); }
    /// The next iteration; of 0 rays where there is none.
    virtual IterationPlan plan(SolverState& state);
    /// Does an iteration. @param plan  Its rays become those that were traced. @return The power that leaves the
    /// scene, averaged as irradiance is. @throws Interrupted
    virtual RgbD iterate(SolverState& state, IterationPlan& plan) = 0;
    /// Completes the solution: what is known of each element beside its irradiance.
    virtual void finish(SolverState& state) const;
    /// Looks at the views that the options have now; importance is found anew.
    virtual void retarget(SolverState& state);

    /// The sources of a light group emit `factor` times what they did when light of it was last found.
    virtual void scale_group(SolverState&, std::size_t /*group*/, float /*factor*/) {}

    virtual void archive(StateArchive& archive) = 0;
    /// Whether what archive() has read can belong to this run.
    virtual bool fits(const SolverState&) const { return true; }
};

}  // namespace interflect::inline detail
