#pragma once

#include <utility>
#include <vector>

#include "interflect/solver/iteration_method.h"
#include "interflect/solver/methods/bounce_budget.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/transport_steps.h"

namespace interflect::inline detail {

/// State of an unfinished pass between two bounces.
struct Pass {
    bool is_under_way = false;
    bool emits = true;        ///< Whether the next bounce is the first.
    FreshEstimate fresh;      ///< Sum of the finished bounces.
    std::vector<Rgb> unshot;  ///< Irradiance of the last bounce, which the next one reflects.
    GroupLight unshot_groups;
    std::vector<std::uint8_t> reflecting_where_received;  ///< leaves_that_blur().
    StartPoints start_points;                             ///< Origins of the next bounce.
    ImportanceWeights weights;
    BounceBudget budget;
    double first_power = 0, first_weighted_power = 0;  ///< See PowerStep; of the first bounce.
};

/// Transport of importance from the views, before the first pass.
struct ImportanceStart {
    bool is_under_way = false;
    std::vector<float> unshot;
    BounceBudget budget;
    double left = 1;  ///< Unshot importance; initially all, 1.
};

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
    /// Restarts the current pass.
    void scale_group(SolverState& state, std::size_t group, float factor) override;
    void archive(StateArchive& archive) override;
    bool fits(const SolverState& state) const override;

    /// Makes a first estimate for other iteration methods: prepare(), then a pass on the resulting mesh.
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

    /// Stages before the first iteration, in order.
    enum class Stage : int { importance, coarse_pass, refining_pass, report, done };
    Stage stage_ = Stage::importance;
    ImportanceStart importance_;
    Pass pass_;
    /// Unshot power, summed over the bounces of the last pass, relative to its first bounce; 0: unknown.
    double bounces_ = 0;
    bool finds_importance_ = false;              // before the next iteration, after a change of views
    std::vector<float> old_q_, old_importance_;  // sampling and patch importance before that change
    std::int64_t rays_before_adaptation_ = 0;
    RgbD escaped_power_{0, 0, 0};  // of the last pass
    bool importance_step_is_done_ = false;
    std::int64_t rays_before_ = 0;  // at the start of the iteration
    std::uint32_t elements_before_ = 0;
};

}  // namespace interflect::inline detail
