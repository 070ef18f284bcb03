#pragma once

#include <algorithm>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/methods/passes.h"

namespace interflect::detail {

/// Well-distributed ray set that keeps every ray (Neumann, Neumann and Bekaert 1997; with refinement, Bekaert et al.
/// 1998). Leaf i has shot n_i = N P_i / sum P rays of payload sum P / N. When P or N changes, an iteration shoots the
/// missing rays; old hits count with the new payload and old colour. A leaf beyond its share pauses.
class WellDistributedRays : public IterationMethod {
  public:
    explicit WellDistributedRays(const SolverState& state);

    void prepare(SolverState& state) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void archive(StateArchive& archive) override;
    bool fits(const SolverState& state) const override {
        const std::size_t elements = state.light.forest->size(), parts = state.inputs.emission.part_count();
        const bool is_whole =
            shot_.size() == elements && received_.size() == elements && shot_by_parts_.size() == parts;
        const auto has_elements = [&](const auto& numbers) { return numbers.size() == elements; };
        const bool has_groups = received_groups_.size() == state.inputs.groups.size() &&
                                std::all_of(received_groups_.begin(), received_groups_.end(), has_elements);
        return passes_.fits(state) && (has_groups || total_ == 0) && (is_whole || total_ == 0);
    }

  private:
    void keep_lacking_rays(const ElementForest& forest, std::int64_t all, RayPlan& plan) const;

    Passes passes_;
    std::vector<double> shot_;           // rays, by leaf
    std::vector<double> shot_by_parts_;  // rays, by luminaire part
    std::vector<Rgb> received_;          // payloads per area, by element and channel [1/m^2]
    GroupLight received_groups_;         // received_ by light group
    RgbD escaped_{0, 0, 0};              // payloads that escaped
    std::int64_t total_ = 0;             // N
};

}  // namespace interflect::detail
