#pragma once

#include <utility>
#include <vector>

#include "interflect/solver/iteration_method.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/transport_steps.h"

namespace interflect::inline detail {

/// Iterations that are passes. A pass shoots the emitted power, then the received power, bounce by bounce, until little
/// is left ('incremental shooting', Neumann et al. 1995). Rays are distributed over the bounces in proportion to unshot
/// power, weighted like the rays (Eq. 3, 10). A pass is an unbiased estimate of all bounces on the current mesh,
/// independent of earlier passes.
class Passes : public IterationMethod {
  public:
    /// Estimates importance and, in methods that refine, makes an initial mesh by Eq. 14 and 15 in two small passes.
    /// The light of the second is the estimate until the first pass is merged; the mean does not include it.
    void prepare(SolverState& state) override;
    /// Traces a pass, merges it with the mean of earlier passes (Eq. 6), and refines the mesh.
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    /// Keeps the averaged light. The next iteration adapts its history to the new views.
    void retarget(SolverState& state) override;
    void archive(StateArchive& archive) override;
    bool fits(const SolverState& state) const override;

    /// Makes a first estimate for other iteration methods: prepare(), then a pass on the resulting mesh.
    void make_first_estimate(SolverState& state);

  protected:
    /// Traces the rays of one bounce. @throws Interrupted
    virtual Received trace(SolverState& state, TransportStep step) { return run_step(state, std::move(step)); }

  private:
    struct Pass;
    bool trace_bounce(SolverState& state, Pass& pass);
    Pass trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines);
    std::vector<float> adapt_to_views(SolverState& state) const;

    /// Unshot power, summed over the bounces of the last pass, relative to its first bounce; 0: unknown.
    double bounces_ = 0;
    bool finds_importance_ = false;              // before the next iteration, after a change of views
    std::vector<float> old_q_, old_importance_;  // sampling and patch importance before that change
};

}  // namespace interflect::inline detail
