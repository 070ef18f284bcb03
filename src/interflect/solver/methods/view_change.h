#pragma once

#include <vector>

#include "interflect/base/state_archive.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Converts history to rays of the new views with the same noise.
class ViewChange {
  public:
    bool empty() const { return old_q_.empty(); }
    /// Call before the views change.
    void record(const SolverState& state);
    void clear() { old_q_.clear(), old_importance_.clear(); }
    /// Returns a factor per patch.
    std::vector<float> history_factor(const SolverState& state) const;

    void archive(StateArchive& archive);
    bool fits(const SolverState& state) const;

  private:
    std::vector<float> old_q_;           // sampling probability, by element
    std::vector<float> old_importance_;  // by patch
};

void scale_history(SolverState& state, const std::vector<float>& factor);

}  // namespace interflect::detail
