#pragma once

#include "interflect/solver/iteration_method.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// Iterations of one bounce each, as in the paper: what is received of the present estimate is merged with the running
/// mean.
class OneBounce : public IterationMethod {
  public:
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    void archive(StateArchive& archive) override;

  private:
    bool importance_step_is_done_ = false;
    std::uint32_t elements_before_ = 0;  // this iteration
};

}  // namespace interflect::inline detail
