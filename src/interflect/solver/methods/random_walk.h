#pragma once

#include <cstdint>

#include "interflect/solver/iteration_method.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Batches of paths of one kind: of light, or of importance.
struct PathSeries {
    std::uint64_t key;  ///< Of their random numbers.
    std::uint64_t batches = 0;
    std::int64_t pilot_rays = 0;  ///< Of the pilot of the first batch.
    double rays_per_path = 0;     ///< Of the last batch, or of the pilot; 0: there was none.
};

/// Solves Eq. 1 of Prikryl et al. 2000 by random walks of particles (Pattanaik and Mudur 1992): a particle leaves an
/// emitter, adds its power to what every patch that it hits receives, and goes on from there, uniformly on the patch,
/// with the probability that the reflectance gives. Behind a pane the transmitted part of the power goes straight on.
/// All channels travel together; survival keeps their sum.
///
/// With importance (Pattanaik and Mudur 1993, 1995) psi is found by random walks from the cameras, with the share alpha
/// of the rays, and the particles are made proportional to power times psi: an emitter sends more of them, each with
/// less; one that hits a patch is split where psi has risen, and dies sooner where it has fallen. A share beta of the
/// paths starts by power alone. Unbiased for every psi while beta > 0.
///
/// Paths are followed to their end, so the rays of a batch come out a per cent or so off the plan. A walk needs no
/// incremental start. Same seed, same bits, for any number of threads. Cost: O(N log(patches)) time on all threads, 150
/// bytes a patch.
class RandomWalks : public IterationMethod {
  public:
    explicit RandomWalks(const SolverState& state);

    /// Begins with importance, so that light does not start before it is known where it matters.
    void prepare(SolverState& state) override;

    /// Follows paths that take about plan.rays rays, and merges what they bring with the running mean (Eq. 6). A batch
    /// counts by the rays planned for it, not by those traced: long paths bring more too, and such weights would add a
    /// bias.
    /// @return The power that leaves the scene, by all batches so far.
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    void retarget(SolverState& state) override;
    void archive(StateArchive& archive) override;

  private:
    std::int64_t lacking_importance(const SolverState& state, std::int64_t planned) const;
    void walk_importance(SolverState& state, std::int64_t rays);
    void walk_light(SolverState& state, std::int64_t rays, const IterationPlan& plan);

    PathSeries light_, importance_;
    RgbD escaped_{0, 0, 0};                // power, mean of all batches
    std::int64_t importance_history_ = 0;  // rays planned for the batches that psi is the mean of
    bool importance_is_done_ = false;      // of this iteration
    std::int64_t for_importance_ = 0, rays_before_ = 0;
};

}  // namespace interflect::inline detail
