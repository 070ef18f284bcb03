#pragma once

#include "interflect/solver/solver_state.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Iterations of one family of methods. If prepare() or iterate() throws Interrupted, the method is as before the call,
/// and the caller restores the SolverState (IterationStart).
class IterationMethod {
  public:
    virtual ~IterationMethod() = default;

    /// Runs the steps before the first iteration. @throws Interrupted
    virtual void prepare(SolverState&) {}
    virtual bool is_fulfilled(const SolverState& state) const { return state.schedule.is_fulfilled(); }
    /// Plans the next iteration; 0 rays if the run is over.
    virtual IterationPlan plan(SolverState& state);
    /// Runs an iteration. @param plan  Receives the number of rays traced. @return Escaped power, averaged like
    /// irradiance.
    /// @throws Interrupted
    virtual RgbD iterate(SolverState& state, IterationPlan& plan) = 0;
    /// Computes the results of each element other than irradiance.
    virtual void finish(SolverState& state) const;
    /// Updates view importance for the current views, and resets indirect importance.
    virtual void retarget(SolverState& state);

    virtual void archive(StateArchive& archive) = 0;
    /// Whether archive() has read a state that fits this run.
    virtual bool fits(const SolverState&) const { return true; }
};

}  // namespace interflect::inline detail
