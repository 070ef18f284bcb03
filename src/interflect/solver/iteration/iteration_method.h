#pragma once

#include <memory>

#include "interflect/base/files/state_archive.h"
#include "interflect/solver/noise/noise_model.h"
#include "interflect/solver/state/schedule.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Steps of an iteration, called by iterate_until(). If a step throws Interrupted, discard() restores the method and
/// IterationStart restores the state.
class IterationMethod {
  public:
    virtual ~IterationMethod() = default;

    /// Traces rays before the first iteration. @throws Interrupted
    virtual void prepare(SolverState&) {}
    virtual bool is_fulfilled(const SolverState& state) const { return state.rays.schedule.is_fulfilled(); }
    /// Plans the next iteration; it has 0 rays if the run is over.
    virtual IterationPlan plan(SolverState& state);
    /// Traces rays that carry importance alone (Eq. 7, 8). @throws Interrupted
    virtual void update_importance(SolverState&, TracedIteration&) {}
    /// Traces the rays of the iteration.
    /// @param iteration  Receives the number of rays, also in update_importance().
    /// @throws Interrupted
    virtual Estimate trace(SolverState& state, TracedIteration& iteration) = 0;
    virtual void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) = 0;
    /// Refines the mesh between iterations. The oracle (Eq. 14, 15) refines during trace().
    virtual void refine(SolverState&) {}
    virtual void discard() {}
    virtual void finish(SolverState& state) const;
    virtual void change_views(SolverState& state);

    virtual void archive(StateArchive& archive) = 0;
    /// Returns whether restored data of the method are consistent with the state.
    virtual bool is_consistent(const SolverState&) const { return true; }
};

/// The state must outlive the method.
std::unique_ptr<IterationMethod> make_iteration_method(SolverState& state);

}  // namespace interflect::detail
