#pragma once

#include <cstdint>
#include <utility>

#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/methods/view_change.h"

namespace interflect::detail {

/// Iterations that are passes ('incremental shooting', Neumann et al. 1995; docs/method/method.md, A run): unbiased
/// estimates on the current mesh, independent of earlier passes.
class Passes : public IterationMethod {
  public:
    /// Estimates importance and makes the initial mesh by two passes (Eq. 14, 15), whose light is not averaged.
    void prepare(SolverState& state) override;
    void update_importance(SolverState& state, TracedIteration& iteration) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void refine(SolverState& state) override;
    /// Keeps the light; ViewChange adapts its history in the next iteration.
    void change_views(SolverState& state) override;
    void archive(StateArchive& archive) override;
    bool is_consistent(const SolverState& state) const override;

    /// Starts another method with prepare() and one pass.
    void make_first_estimate(SolverState& state);

  protected:
    /// Traces a bounce. @throws Interrupted
    virtual Received trace_without_walks(SolverState& state, TransportStep step) {
        return run_step(state, std::move(step));
    }

  private:
    struct Pass;
    Estimate trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines);
    bool trace_bounce(SolverState& state, Pass& pass);
    static TransportStep make_step(const SolverState& state, Pass& pass, RayPlan plan);
    /// Adds the elements that a bounce created. @param old_elements  Number of elements before it.
    static void grow_pass(const ElementForest& forest, std::uint32_t old_elements, Pass& pass);

    /// BounceBudget::total_unshot() of the last pass; 0 before the first pass.
    double total_unshot_ = 0;
    bool needs_importance_ = false;  // whether the next iteration starts with transport_importance()
    ViewChange view_change_;
};

}  // namespace interflect::detail
