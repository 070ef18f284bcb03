#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// State at the start of an iteration. After restore(), a repeated iteration produces the bits of an uninterrupted run.
class IterationStart {
  public:
    explicit IterationStart(const SolverState& state);
    /// Restores the state. Irradiance and its statistics must be unchanged, except for new elements.
    void restore(SolverState& state) const;

  private:
    std::uint32_t elements_;
    SampleStreams streams_;
    std::vector<Imath::Box3f> targets_;
    std::vector<PartImportance> part_importance_;
    std::vector<float> indirect_importance_;
    std::int64_t power_rays_, importance_rays_, escaped_rays_;
    decltype(Solution::non_finite) non_finite_;
    PayloadHistogram payloads_;
    std::size_t reports_;
};

}  // namespace interflect::detail
