#pragma once

#include <cstdint>
#include <utility>

#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/methods/view_change.h"

namespace interflect::detail {

/// Method whose iterations are passes. A pass shoots the emitted power, then the power that each bounce has received,
/// until little is left ('incremental shooting', Neumann et al. 1995; docs/method/method.md, A run). Each pass is an
/// unbiased estimate of the light on the current mesh, independent of earlier passes.
class Passes : public IterationMethod {
  public:
    /// Makes the initial mesh, and reports it as iteration 0. Its light is not part of the mean.
    void prepare(SolverState& state) override;
    void update_importance(SolverState& state, TracedIteration& iteration) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void refine(SolverState& state) override;
    /// Keeps the mean of earlier passes. The next iteration adapts its history weight to the new views (ViewChange).
    void change_views(SolverState& state) override;
    void archive(StateArchive& archive) override;
    bool is_consistent(const SolverState& state) const override;

    /// Makes the initial mesh, then estimates the light by one pass. Reports both together as iteration 0. Methods that
    /// improve a first estimate start with it.
    void make_first_estimate(SolverState& state);

  protected:
    /// Traces a bounce. The last bounce of a pass does not call it, because random walks complete that one. Global
    /// lines override this function. @throws Interrupted
    virtual Received trace_single_bounce(SolverState& state, TransportStep step) {
        return run_step(state, std::move(step));
    }

  private:
    struct Pass;
    /// Estimates the importance. Then two passes refine the mesh (Eq. 14, 15), unless the method does not refine.
    /// @throws Interrupted
    void make_initial_mesh(SolverState& state);
    /// Estimates the importance for the new views, and the factor of the history.
    void adapt_to_new_views(SolverState& state, TracedIteration& iteration);
    /// @throws Interrupted
    Estimate trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines);
    /// Traces the next bounce. Returns false if no unshot light is left. @throws Interrupted
    bool trace_bounce(SolverState& state, Pass& pass);

    double total_unshot_ = 0;        // BounceBudget::total_unshot() of the last pass; 0 before the first pass
    bool needs_importance_ = false;  // whether the views have changed since the last estimate of importance
    ViewChange view_change_;         // sampling for the views before the change; empty without a change
};

}  // namespace interflect::detail
