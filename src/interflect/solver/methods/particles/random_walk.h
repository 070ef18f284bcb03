#pragma once

#include <cstdint>

#include "interflect/base/files/state_archive.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/methods/particles/path_series.h"

namespace interflect::detail {

/// Random walks that solve Eq. 1, Prikryl et al. 2000 (Pattanaik and Mudur 1992). A particle deposits its power at
/// every hit patch and continues from a uniform point on it, with the reflectance as probability.
///
/// With importance (Pattanaik and Mudur 1993, 1995), walks from the cameras estimate psi with the share alpha of the
/// rays. Particles then split where psi rises and end more often where it falls. Unbiased while beta > 0.
///
/// Paths are traced to their end, so ray counts deviate by about 1% from the plan.
class RandomWalks : public IterationMethod {
  public:
    explicit RandomWalks(const SolverState& state);

    void prepare(SolverState& state) override;

    void update_importance(SolverState& state, TracedIteration& iteration) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    /// Merges by Eq. 6, weighted by planned rays. Traced rays would cause a bias, because long paths also deposit more.
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void discard() override { current_ = before_; }
    void change_views(SolverState& state) override;
    void archive(StateArchive& archive) override;

  private:
    std::int64_t missing_importance_rays(const SolverState& state, std::int64_t planned) const;
    void walk_importance(SolverState& state, std::int64_t rays);

    struct Series {
        PathSeries light, importance;
        std::int64_t importance_history = 0;  // number of planned rays that are averaged in psi
    };
    Series current_, before_;
};

}  // namespace interflect::detail
