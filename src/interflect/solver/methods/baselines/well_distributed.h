#pragma once

#include <algorithm>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/methods/passes.h"

namespace interflect::detail {

/// Well-distributed ray set that keeps every ray (Neumann, Neumann and Bekaert 1997; with refinement, Bekaert et al.
/// 1998). Leaf i of power P_i has shot n_i = N P_i / sum P of all N rays. Each ray has the payload sum P / N. When P or
/// N changes, an iteration shoots the missing rays. Earlier hits count with the new payload, but with their old colour.
/// A leaf that has shot more than its share pauses.
class WellDistributedRays : public IterationMethod {
  public:
    explicit WellDistributedRays(const SolverState& state);

    void prepare(SolverState& state) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void archive(StateArchive& archive) override;
    bool is_consistent(const SolverState& state) const override {
        const std::size_t elements = state.light.forest->size(), parts = state.inputs.emission.part_count();
        const bool is_whole =
            shot_.size() == elements && received_.size() == elements && shot_by_parts_.size() == parts;
        const auto has_elements = [&](const auto& numbers) { return numbers.size() == elements; };
        const bool has_groups = received_groups_.size() == state.inputs.groups.size() &&
                                std::all_of(received_groups_.begin(), received_groups_.end(), has_elements);
        return passes_.is_consistent(state) && (has_groups || total_ == 0) && (is_whole || total_ == 0);
    }

  private:
    void plan_missing_rays(const ElementForest& forest, std::int64_t all, RayPlan& plan) const;

    Passes passes_;
    std::vector<double> shot_;           // number of rays from each leaf
    std::vector<double> shot_by_parts_;  // number of rays from each luminaire part
    std::vector<Rgb> received_;          // number of received payloads per area, by element and channel [1/m^2]
    GroupLight received_groups_;         // received_ for each light group
    RgbD escaped_{0, 0, 0};              // number of payloads that escaped, by channel
    std::int64_t total_ = 0;             // number N of all rays
};

}  // namespace interflect::detail
