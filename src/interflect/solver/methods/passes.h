#pragma once

#include <utility>
#include <vector>

#include "interflect/solver/iteration_method.h"
#include "interflect/solver/methods/bounce_budget.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/transport_steps.h"

namespace interflect::inline detail {

/// A pass under way: what one bounce leaves to the next.
struct Pass {
    bool is_under_way = false;
    bool emits = true;        ///< The next bounce is the first.
    FreshEstimate fresh;      ///< What all bounces so far brought.
    std::vector<Rgb> unshot;  ///< Of that, what is to be shot next.
    GroupLight unshot_groups;
    std::vector<std::uint8_t> reflecting_where_received;  ///< leaves_that_blur().
    StartPoints start_points;                             ///< Origins of the next bounce.
    ImportanceWeights weights;
    BounceBudget budget;
    double first_power = 0, first_weighted_power = 0;  ///< Of the first bounce, see PowerStep.
};

/// Importance on its way from the views, before the first pass.
struct ImportanceStart {
    bool is_under_way = false;
    std::vector<float> unshot;
    BounceBudget budget;
    double left = 1;  ///< Of all importance, still to be shot.
};

/// Iterations that are passes. A pass shoots what the emitters emit, then what that brought, and so on, bounce by
/// bounce, until little is left ('incremental shooting', Neumann et al. 1995). Each bounce gets rays in proportion to
/// what is left to shoot, weighed as rays are (Eq. 3, 10). An unbiased estimate of all bounces on the mesh as it is,
/// independent of earlier passes.
class Passes : public IterationMethod {
  public:
    /// Finds importance and, where the method refines, an initial mesh by Eq. 14 and 15, from two small passes. The
    /// light of the second is the estimate until passes are merged, but none of it counts then.
    void prepare(SolverState& state) override;
    /// A pass: its estimate is merged with the mean of those before (Eq. 6), then the mesh is refined.
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    /// What is known of the light is kept, and counts as much as it is worth.
    void retarget(SolverState& state) override;
    /// The pass under way begins anew.
    void scale_group(SolverState& state, std::size_t group, float factor) override;
    void archive(StateArchive& archive) override;
    bool fits(const SolverState& state) const override;

    /// A first estimate for iterations of another kind: prepare(), then a pass on the mesh of that.
    void make_first_estimate(SolverState& state);

  protected:
    /// Traces the rays of one bounce. @throws Interrupted
    virtual Received trace(SolverState& state, TransportStep step) { return run_step(state, std::move(step)); }

  private:
    void start_importance(SolverState& state, std::int64_t rays);
    void adapt_to_views(SolverState& state);
    FreshEstimate trace_pass(SolverState& state, std::int64_t rays, bool oracle_refines);
    void begin_pass(SolverState& state, std::int64_t rays, bool oracle_refines);
    std::int64_t trace_bounce(SolverState& state, std::int64_t rays, bool oracle_refines);

    /// What is done before the first iteration, in this order.
    enum class Stage : int { importance, coarse_pass, refining_pass, report, done };
    Stage stage_ = Stage::importance;
    ImportanceStart importance_;
    Pass pass_;
    /// Sum over the bounces of the last pass of what was left to shoot, relative to its first bounce; 0: not known yet.
    double bounces_ = 0;
    bool finds_importance_ = false;              // before the next iteration: the views have changed
    std::vector<float> old_q_, old_importance_;  // how rays were shared before, and by what, of patches
    std::int64_t rays_before_adaptation_ = 0;
    RgbD escaped_power_{0, 0, 0};  // of the last pass
    bool importance_step_is_done_ = false;
    std::int64_t rays_before_ = 0;  // this iteration
    std::uint32_t elements_before_ = 0;
};

}  // namespace interflect::inline detail
