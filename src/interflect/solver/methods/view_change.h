#pragma once

#include <vector>

#include "interflect/base/state_archive.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Sampling and importance before the views changed. They give the averaged light its history for the new views: the
/// number of new rays with the same noise. The history shrinks where the new views increase the ray density and grows
/// elsewhere.
class ViewChange {
  public:
    bool empty() const { return old_q_.empty(); }
    /// Records the state before the views change.
    void record(const SolverState& state);
    void clear() { old_q_.clear(), old_importance_.clear(); }
    /// Returns the factor of each patch's history. The state has the importance of the new views.
    std::vector<float> history_factor(const SolverState& state) const;

    void archive(StateArchive& archive);
    bool fits(const SolverState& state) const;

  private:
    std::vector<float> old_q_;           // sampling probability of each element
    std::vector<float> old_importance_;  // of each patch
};

/// Multiplies the history of each patch's elements. @param factor  One for each patch, or empty.
void scale_history(SolverState& state, const std::vector<float>& factor);

}  // namespace interflect::detail
