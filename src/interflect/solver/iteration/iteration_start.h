#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// State at the start of an iteration. After restore(), a repeated iteration produces the bits of an uninterrupted run.
/// Keeps SamplingState::importance_at_start while it exists.
class IterationStart {
  public:
    /// The state must outlive this.
    explicit IterationStart(SolverState& state);
    ~IterationStart();
    IterationStart(const IterationStart&) = delete;
    IterationStart& operator=(const IterationStart&) = delete;
    /// Restores the state. Irradiance and its statistics must be unchanged, except for new elements.
    void restore();

  private:
    SolverState& state_;
    std::uint32_t elements_;
    SampleStreams streams_;
    std::vector<Imath::Box3f> targets_;
    std::vector<PartImportance> part_importance_;
    std::int64_t power_rays_, importance_rays_, escaped_rays_;
    decltype(Solution::non_finite) non_finite_;
    PayloadHistogram payloads_;
    std::size_t reports_;
};

}  // namespace interflect::detail
