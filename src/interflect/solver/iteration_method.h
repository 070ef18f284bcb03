#pragma once

#include "interflect/solver/solver_state.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Iterations of one family of methods. If a function throws Interrupted, the next call resumes with the interrupted
/// step.
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

    /// Scales the stored light of a group by `factor`, like its sources.
    virtual void scale_group(SolverState&, std::size_t /*group*/, float /*factor*/) {}

    virtual void archive(StateArchive& archive) = 0;
    /// Whether archive() has read a state that fits this run.
    virtual bool fits(const SolverState&) const { return true; }
};

}  // namespace interflect::inline detail
