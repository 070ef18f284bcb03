#pragma once

#include <ImathBox.h>

#include <span>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/solver/iteration/outdoor_targets.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Converts history to rays of the new views with the same noise.
class ViewChange {
  public:
    bool empty() const { return old_.q.empty(); }
    /// Call before the views change.
    void record(const SolverState& state);
    void clear() { *this = {}; }
    /// Returns a factor per patch.
    /// @param outdoor_light  Lines to surfaces that are important for the new views.
    std::vector<float> history_factor(const SolverState& state, std::span<const OutdoorLine> outdoor_light) const;

    void archive(StateArchive& archive);
    bool fits(const SolverState& state) const;

  private:
    struct Sampling {
        std::vector<float> q, part_q;  // probability by element, by luminaire part
        std::vector<Imath::Box3f> targets;
    };
    static Sampling sampling_of(const SolverState& state);

    Sampling old_;
    std::vector<float> old_importance_;  // by patch
};

void scale_history(LightState& light, const std::vector<float>& factor);

}  // namespace interflect::detail
