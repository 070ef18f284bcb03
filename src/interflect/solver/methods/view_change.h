#pragma once

#include <ImathBox.h>

#include <span>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/solver/iteration/outdoor_targets.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Converts the history after a change of views to the number of rays that would give the same noise with the sampling
/// for the new views.
class ViewChange {
  public:
    bool empty() const { return old_.q.empty(); }
    /// Records the sampling of the current views. Call before the views change.
    void record(const SolverState& state);
    void clear() { *this = {}; }
    /// Returns a factor per patch.
    /// @param outdoor_light  Lines to surfaces that are important for the new views.
    std::vector<float> history_factor(const SolverState& state, std::span<const OutdoorLine> outdoor_light) const;

    void archive(StateArchive& archive);
    bool is_consistent(const SolverState& state) const;

  private:
    struct Sampling {
        std::vector<float> q, part_q;  // sampling probability of each element and of each luminaire part
        std::vector<Imath::Box3f> targets;
    };
    static Sampling sampling_of(const SolverState& state);

    Sampling old_;
    std::vector<float> old_importance_;  // importance of each patch
};

void scale_history(LightState& light, const std::vector<float>& factor);

}  // namespace interflect::detail
