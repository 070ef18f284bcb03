#pragma once

#include "interflect/solver/iteration_method.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Iterations of one bounce each, as in the paper. The light received from the current estimate is merged with the
/// running mean (Eq. 6).
class OneBounce : public IterationMethod {
  public:
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    void archive(StateArchive&) override {}
};

}  // namespace interflect::inline detail
