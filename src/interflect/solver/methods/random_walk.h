#pragma once

#include <cstdint>

#include "interflect/solver/iteration_method.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

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

    /// Traces paths for about plan.rays rays and merges the result with the running mean (Eq. 6). The weight of a batch
    /// is its planned number of rays, not the traced number: long paths also deposit more, so such weights would cause
    /// a bias.
    /// @return Escaped power, averaged over all batches so far.
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    void retarget(SolverState& state) override;
    void archive(StateArchive& archive) override;

  private:
    std::int64_t lacking_importance(const SolverState& state, std::int64_t planned) const;
    void walk_importance(SolverState& state, std::int64_t rays);
    void walk_light(SolverState& state, std::int64_t rays, const IterationPlan& plan);

    PathSeries light_, importance_;
    RgbD escaped_{0, 0, 0};                // power, mean of all batches
    std::int64_t importance_history_ = 0;  // planned rays of the batches in the mean of psi
};

}  // namespace interflect::inline detail
