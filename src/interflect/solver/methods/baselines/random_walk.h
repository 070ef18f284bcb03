#pragma once

#include <cstdint>

#include "interflect/base/state_archive.h"
#include "interflect/solver/iteration/iteration_method.h"

namespace interflect::detail {

/// Batches of paths of one kind: light or importance.
struct PathSeries {
    std::uint64_t key;  ///< Key of their random numbers.
    std::uint64_t batches = 0;
    std::int64_t pilot_rays = 0;  ///< Rays of the pilot of the first batch.
    double rays_per_path = 0;     ///< In the last batch or the pilot; 0: not measured.
};

/// Random walks of particles that solve Eq. 1 of Prikryl et al. 2000 (Pattanaik and Mudur 1992). A particle leaves an
/// emitter and deposits its power at every patch that it hits. It continues from a uniform point on the patch, with a
/// probability given by the reflectance. Behind a pane, the transmitted power continues straight. A particle carries
/// all channels; survival keeps their sum.
///
/// With importance (Pattanaik and Mudur 1993, 1995), random walks from the cameras estimate psi with the share alpha of
/// the rays. The density of particles is then proportional to power times psi. An emitter with larger psi sends more
/// particles, each with less power. A particle is split if psi rises at a hit, and more likely to end if it falls.
/// Power alone starts the share beta of the paths. Unbiased for every psi while beta > 0.
///
/// Paths are traced to their end, so the rays of a batch deviate by about a per cent from the plan. No incremental
/// start is needed. The same seed gives the same bits for any number of threads. Cost: O(N log(patches)) time on all
/// threads, 150 bytes per patch.
class RandomWalks : public IterationMethod {
  public:
    explicit RandomWalks(const SolverState& state);

    /// Computes importance, which guides the first light paths.
    void prepare(SolverState& state) override;

    void update_importance(SolverState& state, IterationPlan& plan) override;
    /// Traces paths for about plan.rays rays.
    Estimate trace(SolverState& state, IterationPlan& plan) override;
    /// Merges the estimate with the running mean (Eq. 6). The weight of a batch is its planned number of rays, not the
    /// traced number: long paths also deposit more, so such weights would cause a bias.
    void merge(SolverState& state, const Estimate& estimate, const IterationPlan& plan) override;
    void discard() override { current_ = before_; }
    void change_views(SolverState& state) override;
    void archive(StateArchive& archive) override;

  private:
    std::int64_t lacking_importance(const SolverState& state, std::int64_t planned) const;
    void walk_importance(SolverState& state, std::int64_t rays);

    struct Series {
        PathSeries light, importance;
        std::int64_t importance_history = 0;  // planned rays of the batches in the mean of psi
    };
    Series current_, before_;  // the latter before the iteration
};

}  // namespace interflect::detail
