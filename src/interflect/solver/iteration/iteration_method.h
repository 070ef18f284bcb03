#pragma once

#include <memory>

#include "interflect/base/files/state_archive.h"
#include "interflect/solver/noise/noise_model.h"
#include "interflect/solver/state/schedule.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Called by iterate_until(). After Interrupted, discard() restores the method and IterationStart the state.
class IterationMethod {
  public:
    virtual ~IterationMethod() = default;

    /// @throws Interrupted
    virtual void prepare(SolverState&) {}
    virtual bool is_fulfilled(const SolverState& state) const { return state.rays.schedule.is_fulfilled(); }
    /// Returns 0 rays if the run is over.
    virtual IterationPlan plan(SolverState& state);
    /// With rays that carry importance alone (Eq. 7, 8). @throws Interrupted
    virtual void update_importance(SolverState&, TracedIteration&) {}
    /// @param iteration  Receives the number of rays, as in update_importance(). @throws Interrupted
    virtual Estimate trace(SolverState& state, TracedIteration& iteration) = 0;
    virtual void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) = 0;
    /// Between iterations; Eq. 14 and 15 refine during trace().
    virtual void refine(SolverState&) {}
    virtual void discard() {}
    virtual void finish(SolverState& state) const;
    virtual void change_views(SolverState& state);

    virtual void archive(StateArchive& archive) = 0;
    virtual bool fits(const SolverState&) const { return true; }
};

/// The state must outlive the method.
std::unique_ptr<IterationMethod> make_iteration_method(SolverState& state);

}  // namespace interflect::detail
