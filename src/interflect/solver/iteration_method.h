#pragma once

#include "interflect/solver/solver_state.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Iterations of one family of methods, with their own state. A function that threw Interrupted may be called again and
/// resumes with the interrupted step.
class IterationMethod {
  public:
    virtual ~IterationMethod() = default;

    /// Runs the steps before the first iteration. @throws Interrupted
    virtual void prepare(SolverState&) {}
    /// Whether the run has reached the limits of its options.
    virtual bool is_fulfilled(const SolverState& state) const { return state.schedule.is_fulfilled(); }
    /// Plans the next iteration; 0 rays if the run is over.
    virtual IterationPlan plan(SolverState& state);
    /// Runs an iteration. @param plan  Receives the number of rays traced. @return Escaped power, averaged like
    /// irradiance.
    /// @throws Interrupted
    virtual RgbD iterate(SolverState& state, IterationPlan& plan) = 0;
    /// Completes the solution: computes the other results of each element.
    virtual void finish(SolverState& state) const;
    /// Recomputes the view importance for the current views, and resets the indirect importance.
    virtual void retarget(SolverState& state);

    /// Scales the stored light of a group. Its sources emit `factor` times the light for which it was computed.
    virtual void scale_group(SolverState&, std::size_t /*group*/, float /*factor*/) {}

    virtual void archive(StateArchive& archive) = 0;
    /// Whether the state read by archive() fits this run.
    virtual bool fits(const SolverState&) const { return true; }
};

}  // namespace interflect::inline detail
