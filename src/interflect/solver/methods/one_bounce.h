#pragma once

#include "interflect/solver/iteration/iteration_method.h"

namespace interflect::detail {

/// Iterations of one bounce each, as in the paper (Eq. 6).
class OneBounce : public IterationMethod {
  public:
    void update_importance(SolverState& state, TracedIteration& iteration) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void archive(StateArchive&) override {}
};

}  // namespace interflect::detail
