#pragma once

#include "interflect/solver/iteration/iteration_method.h"

namespace interflect::detail {

/// Iterations of one bounce each, as in the paper (Eq. 6).
class OneBounce : public IterationMethod {
  public:
    void update_importance(SolverState& state, IterationPlan& plan) override;
    Estimate trace(SolverState& state, IterationPlan& plan) override;
    void merge(SolverState& state, const Estimate& estimate, const IterationPlan& plan) override;
    void archive(StateArchive&) override {}
};

}  // namespace interflect::detail
