#pragma once

#include "interflect/solver/solver_state.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Iterations of one family of methods. A function that threw Interrupted resumes with the interrupted step when called
/// again.
class IterationMethod {
  public:
    virtual ~IterationMethod() = default;

    /// Precedes the first iteration. @throws Interrupted
    virtual void prepare(SolverState&) {}
    virtual bool is_fulfilled(const SolverState& state) const { return state.schedule.is_fulfilled(); }
    /// @return 0 rays if the run is over.
    virtual IterationPlan plan(SolverState& state);
    /// @param plan  Receives the number of rays traced. @return Escaped power, averaged like irradiance.
    /// @throws Interrupted
    virtual RgbD iterate(SolverState& state, IterationPlan& plan) = 0;
    /// Computes the remaining results of each element.
    virtual void finish(SolverState& state) const;
    /// Updates view importance for the current views, and resets indirect importance.
    virtual void retarget(SolverState& state);

    /// Scales the stored light of a group. Its sources now emit `factor` times the corresponding light.
    virtual void scale_group(SolverState&, std::size_t /*group*/, float /*factor*/) {}

    virtual void archive(StateArchive& archive) = 0;
    /// Whether archive() has read a state of this run.
    virtual bool fits(const SolverState&) const { return true; }
};

}  // namespace interflect::inline detail
