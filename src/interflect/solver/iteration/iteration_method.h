#pragma once

#include <memory>

#include "interflect/base/state_archive.h"
#include "interflect/solver/noise/noise_model.h"
#include "interflect/solver/state/schedule.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// The steps of one family of methods; iterate_until() (solve.cpp) calls them. If prepare(), update_importance() or
/// trace() throws Interrupted, the caller discards the iteration: discard() restores the method, IterationStart the
/// state.
class IterationMethod {
  public:
    virtual ~IterationMethod() = default;

    /// Runs the steps before the first iteration. @throws Interrupted
    virtual void prepare(SolverState&) {}
    virtual bool is_fulfilled(const SolverState& state) const { return state.schedule.is_fulfilled(); }
    /// Plans the next iteration; 0 rays if the run is over.
    virtual IterationPlan plan(SolverState& state);
    /// Traces rays that carry importance alone, and merges their result (Eq. 7, 8). @throws Interrupted
    virtual void update_importance(SolverState&, IterationPlan&) {}
    /// Traces the rays of an iteration. @param plan  Receives the number of rays. @throws Interrupted
    virtual Estimate trace(SolverState& state, IterationPlan& plan) = 0;
    /// Merges the estimate with the running mean (Eq. 6).
    virtual void merge(SolverState& state, const Estimate& estimate, const IterationPlan& plan) = 0;
    /// Refines the mesh between iterations. Eq. 14 and 15 refine it during trace().
    virtual void refine(SolverState&) {}
    /// Discards the changes of an interrupted iteration.
    virtual void discard() {}
    /// Computes the results of each element other than irradiance.
    virtual void finish(SolverState& state) const;
    /// Updates view importance for the current views, and resets indirect importance.
    virtual void change_views(SolverState& state);

    virtual void archive(StateArchive& archive) = 0;
    /// Whether archive() has read a state that fits this run.
    virtual bool fits(const SolverState&) const { return true; }
};

/// Makes the method that the options name. The state must outlive it.
std::unique_ptr<IterationMethod> make_iteration_method(SolverState& state);

}  // namespace interflect::detail
