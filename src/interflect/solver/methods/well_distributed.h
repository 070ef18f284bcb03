#pragma once

#include <algorithm>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/iteration_method.h"
#include "interflect/solver/methods/passes.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// The rays of a run in which every ray is kept: all that were ever shot stand for the present estimate together, as a
/// well-distributed ray set (Neumann, Neumann and Bekaert 1997; with refinement, Bekaert et al. 1998). Leaf i has shot
/// n_i = N P_i / sum P rays, each of which carries the quantum sum P / N; when the estimate of P changes, or N grows,
/// an iteration shoots what each leaf lacks, and old hits count on with the new quantum. A leaf that has shot more than
/// its share shoots again when N has grown enough; until then N is a little larger than was planned, so that all rays
/// together carry sum P. The colour of a ray stays what it was when it was shot.
class WellDistributedRays : public IterationMethod {
  public:
    explicit WellDistributedRays(const SolverState& state);

    /// With complete passes: a first estimate by one of them.
    void prepare(SolverState& state) override;
    /// Grows N by plan.rays and takes the irradiance from all rays so far.
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    void archive(StateArchive& archive) override;
    bool fits(const SolverState& state) const override {
        const std::size_t elements = state.forest->size(), parts = state.emission.part_count();
        const bool is_whole = shot_.size() == elements && arrived_.size() == elements && shot_by_parts_.size() == parts;
        const auto has_elements = [&](const auto& numbers) { return numbers.size() == elements; };
        const bool has_groups = arrived_groups_.size() == state.groups.size() &&
                                std::all_of(arrived_groups_.begin(), arrived_groups_.end(), has_elements);
        return passes_.fits(state) && (has_groups || total_ == 0) && (is_whole || total_ == 0);
    }

  private:
    void keep_lacking_rays(const ElementForest& forest, std::int64_t all, TransportStep& step) const;

    Passes passes_;                      // before the first iteration
    std::vector<double> shot_;           // rays of each leaf
    std::vector<double> shot_by_parts_;  // rays of each part of the luminaires
    std::vector<Rgb> arrived_;           // quanta per area at each element, split to colours [1/m^2]
    GroupLight arrived_groups_;          // of that, what each light group brought
    RgbD escaped_{0, 0, 0};              // quanta that left the scene
    std::int64_t total_ = 0;             // N: rays of all leaves
};

}  // namespace interflect::inline detail
