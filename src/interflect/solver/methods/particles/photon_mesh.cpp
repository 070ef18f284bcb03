#include "interflect/solver/methods/particles/photon_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/iteration/merge.h"
#include "interflect/solver/methods/particles/path_series.h"
#include "interflect/solver/refinement/divide_leaves.h"
#include "interflect/solver/transport/received.h"

namespace interflect::detail {

namespace {

/// The statistic has the distribution of chi-squared only with at least five expected hits per quarter (Cochran 1954).
constexpr double fewest_hits_of_quarter = 5;
/// Evenly lit elements exceed this value of chi-squared, of three degrees of freedom, with a probability of 5%.
constexpr double significant = 7.815;
/// Largest invisible difference: root mean square over the quarters, relative to their mean (Weber).
constexpr double invisible_difference = 0.02;
/// Patches with more than this share of all area are divided twice at first. There are at most 1000 such patches, which
/// have 16,000 elements.
constexpr double large_share = 1e-3;

/// Adaptive subdivision by particles (Heckbert 1990; Tobler, Wilkie, Feda and Purgathofer 1997). Particles move as in
/// RandomWalks, but reflected particles start at their hit points. The leaves of the forest are the quarters of the
/// elements of the paper. An element is divided when the hits of its quarters differ. The quarters then become elements
/// with quarters of their own (docs/method/method.md).
class PhotonMesh final : public IterationMethod {
  public:
    explicit PhotonMesh(const SolverState& state)
        : current_{sub_key(state.light.options().seed, WalkPurpose::light)}, hits_(state.light.forest->size()) {}

    void prepare(SolverState& state) override;
    void update_importance(SolverState&, TracedIteration&) override { before_ = current_; }
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void refine(SolverState& state) override;
    void discard() override { current_ = before_; }
    void archive(StateArchive& archive) override;
    bool is_consistent(const SolverState& state) const override {
        return hits_.size() == state.light.forest->size() &&
               std::all_of(hits_.begin(), hits_.end(),
                           [](const HitSum& hits) { return hits.sum() >= 0 && hits.squares() >= 0; });
    }

  private:
    bool has_quarters_to_divide(const SolverState& state, ElementIndex e) const;
    double discarded_share(const ElementForest& forest) const;

    PathSeries current_, before_;
    std::vector<HitSum> fresh_hits_;  // hits of the iteration, by leaf
    /// Hits of each element from its creation to its division.
    std::vector<HitSum> hits_;
};

/// Divides the patches, so that quarters count all hits. Divides the quarters of large patches as well, because
/// symmetric light may be equal on the four quarters of a patch.
void PhotonMesh::prepare(SolverState& state) {
    before_ = current_;
    const ElementForest& forest = *state.light.forest;
    double total_area = 0;
    for (PatchIndex i{0}; i < forest.patch_count(); ++i) total_area += forest.area(i);
    for (const double least_area : {0.0, large_share * total_area}) {
        std::vector<std::uint8_t> splits(forest.size());
        for (ElementIndex e{0}; e < splits.size(); ++e)
            splits[e] = forest.is_leaf(e) && forest.area(e) >= 4 * min_area(state.inputs, state.light, e) &&
                        forest.area(forest.patch(e)) > least_area;
        divide_leaves(state, splits);
    }
    hits_.assign(state.light.forest->size(), {});
}

Estimate PhotonMesh::trace(SolverState& state, TracedIteration& iteration) {
    WalkSource light = light_source(state.inputs, state.light);
    light.starts_at_hits = true;
    BatchResult batch = walk(state, light, iteration.plan.rays, current_);
    state.rays.power += batch.rays;
    if (batch.rays > 0) iteration.rays = batch.rays;
    fresh_hits_ = std::move(batch.hits);
    const ElementForest& forest = *state.light.forest;
    Estimate estimate{.irradiance = std::move(batch.irradiance), .escaped_power = batch.escaped};
    estimate.variance.assign(forest.size(), 0.0f);
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        if (!(fresh_hits_[e].sum() > 0)) continue;
        const double per_hit = luminance(estimate.irradiance[e]) / fresh_hits_[e].sum();
        estimate.variance[e] = static_cast<float>(per_hit * per_hit * fresh_hits_[e].squares());
    }
    pull_variance(forest, estimate.variance);
    return estimate;
}

/// Merges an iteration, weighted by planned rays as in RandomWalks.
void PhotonMesh::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    // The last iteration may be too small to estimate noise.
    const bool shows_error = iteration.weight >= state.rays.schedule.start_rays();
    if (shows_error) estimate_noise(state, estimate, iteration.weight);
    merge_independent(state.light, state.light.solution.irradiance, estimate.irradiance, iteration);
    merge_escaped_power(state.light, estimate.escaped_power, iteration);
    update_history(state.light, iteration);
    for (std::size_t e = 0; e < hits_.size(); ++e) hits_[e] += fresh_hits_[e];
}

bool PhotonMesh::has_quarters_to_divide(const SolverState& state, ElementIndex e) const {
    const ElementForest& forest = *state.light.forest;
    const ElementIndex first = forest.first_child(e);
    if (first == none) return false;
    std::array<HitSum, 4> hits;
    std::array<float, 4> areas{};
    for (std::uint32_t k = 0; k < 4; ++k) {
        const ElementIndex quarter = first + k;
        hits[k] = hits_[quarter];
        areas[k] = forest.area(quarter);
        if (!forest.is_leaf(quarter) || areas[k] < 4 * min_area(state.inputs, state.light, quarter)) return false;
    }
    return quarters_differ(hits, areas);
}

void PhotonMesh::refine(SolverState& state) {
    const ElementForest& forest = *state.light.forest;
    std::vector<std::uint8_t> splits(forest.size(), 0);
    parallel_for_ranges(splits.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e)
            if (has_quarters_to_divide(state, e)) std::fill_n(&splits[forest.first_child(e)], 4, std::uint8_t{1});
    });
    divide_leaves(state, splits);
    hits_.resize(forest.size());
    state.light.discarded_hits = discarded_share(forest);
}

/// Returns the share of discarded hits. The hits of an element before its division are not divided among its
/// quarters. They are lost when the quarters become elements.
double PhotonMesh::discarded_share(const ElementForest& forest) const {
    double discarded = 0, all = 0;
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        all += hits_[e].sum();
        const ElementIndex first = forest.first_child(e);
        if (first != none && !forest.is_leaf(first)) discarded += hits_[e].sum();
    }
    return all > 0 ? discarded / all : 0;
}

void PhotonMesh::archive(StateArchive& archive) {
    archive("photon_mesh/series", current_);
    require_valid(current_, "photon_mesh/series");
    archive("photon_mesh/hits", hits_);
}

}  // namespace

bool quarters_differ(const std::array<HitSum, 4>& hits, const std::array<float, 4>& areas) {
    double area = 0;
    HitSum all;
    for (std::size_t k = 0; k < 4; ++k) {
        area += areas[k];
        all += hits[k];
    }
    if (!(all.sum() > 0)) return false;
    // Number of equal hits with the same relative noise.
    const double effective_hits = all.sum() * all.sum() / all.squares();
    if (effective_hits * *std::min_element(areas.begin(), areas.end()) < fewest_hits_of_quarter * area) return false;
    double chi_squared = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const double share = areas[k] / area, difference = hits[k].sum() - share * all.sum();
        chi_squared += difference * difference / (share * all.squares());
    }
    constexpr double degrees_of_freedom = 3;
    // Estimated mean square of the relative differences.
    const double square = (chi_squared - degrees_of_freedom) / effective_hits;
    return chi_squared > significant && square > invisible_difference * invisible_difference;
}

std::unique_ptr<IterationMethod> make_photon_mesh(SolverState& state) { return std::make_unique<PhotonMesh>(state); }

}  // namespace interflect::detail
