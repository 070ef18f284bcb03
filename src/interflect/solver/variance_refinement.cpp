#include "interflect/solver/variance_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"

namespace interflect::inline detail {

namespace {

/// The mean square by which a leaf's children will differ, over that of its own siblings: a quarter where irradiance is
/// linear, a half where an edge runs through.
constexpr float expected_decay = 0.3f;
/// The same over the square of its irradiance, for a leaf without siblings: nothing is known of it.
constexpr float assumed_square = 0.04f;
/// Children are made once their expected differences are this share of the noise that they would have with the rays so
/// far. More rays will come, and until then the differences are reduced to what they are worth.
constexpr float least_signal = 0.12f;
/// A leaf is left alone if what splitting it gains is less than this share of the whole squared error.
constexpr double negligible_gain = 2e-7;
/// A leaf is split too if it radiates more than this share of all light from other places than it should: what is
/// reflected from a bright corner of a lamp's housing leaves it less easily than it would from everywhere.
constexpr double negligible_misplacement = 1e-7;
/// How much the squared error of the shape of what is not seen counts beside what is: it reaches the view spread out.
constexpr double unseen_shape = 0.02;

/// Decides about the leaves of a run.
class VarianceOracle {
  public:
    explicit VarianceOracle(const SolverState& state) : state_(state), forest_(*state.forest) {
        const double error = solution_error(state).total();
        least_gain_ = std::isfinite(error) ? negligible_gain * error * error * weighted_mean_square() : 0;
        least_misplaced_power_ = negligible_misplacement * received_power();
    }

    bool splits(std::uint32_t leaf) const {
        float signal, noise;  // of the children to be
        if (leaf < forest_.patch_count()) {
            const float h = luminance(state_.solution.irradiance[leaf]);
            signal = assumed_square * h * h;
            noise = 3 * state_.noise.variance(forest_, state_.solution.irradiance, leaf, state_.history[leaf]);
        } else {
            const Detail detail = detail_of(state_, forest_.first_child(forest_.parent(leaf)));
            signal = expected_decay * detail.signal();
            noise = 4 * detail.noise;
        }
        if (!(signal > least_signal * noise)) return false;
        const bool blurs = weight(leaf) * static_cast<double>(signal) > least_gain_ &&
                           forest_.area(leaf) >= 4 * min_area(state_, leaf);
        const bool misplaces =
            misplaced_power(leaf, signal) > least_misplaced_power_ && forest_.area(leaf) >= 4 * state_.floor.unseen();
        return blurs || misplaces;
    }

  private:
    /// Of the squared error of the luminance of its irradiance.
    double weight(std::uint32_t leaf) const {
        double w = error_weight(state_, leaf);
        if (!state_.solution.indirect_importance.empty()) {
            const double rho = luminance(state_.materials.surface(forest_.patch(leaf), leaf).reflectance);
            w += unseen_shape * rho * rho * static_cast<double>(state_.solution.indirect_importance[leaf]);
        }
        return w * forest_.area(leaf);
    }
    /// Power that leaves the leaf from other places than it should, times what power from there matters to the view.
    double misplaced_power(std::uint32_t leaf, float signal) const {
        const std::vector<float>& psi = state_.solution.indirect_importance;
        const double rho = luminance(state_.materials.surface(forest_.patch(leaf), leaf).reflectance);
        return rho * std::sqrt(static_cast<double>(signal)) * forest_.area(leaf) * (psi.empty() ? 1.0 : psi[leaf]);
    }
    double weighted_mean_square() const {
        const double mean = error_reference(state_);
        double weight = state_.view.empty() ? 0 : 1;
        if (state_.view.empty())
            for (std::uint32_t i = 0; i < forest_.patch_count(); ++i) weight += forest_.area(i);
        return mean * mean * weight;
    }

    /// What all surfaces receive, by its importance.
    double received_power() const {
        const std::vector<float>& psi = state_.solution.indirect_importance;
        double sum = 0;
        for (std::uint32_t i = 0; i < forest_.patch_count(); ++i)
            sum += static_cast<double>(luminance(state_.solution.irradiance[i])) * forest_.area(i) *
                   (psi.empty() ? 1.0f : psi[i]);
        return sum;
    }

    const SolverState& state_;
    const ElementForest& forest_;
    double least_gain_ = 0;             // [weight times irradiance^2]
    double least_misplaced_power_ = 0;  // [lm or W, times importance]
};

}  // namespace

void refine_by_variance(SolverState& state) {
    ElementForest& forest = *state.forest;
    const std::uint32_t before = forest.size();
    const VarianceOracle oracle(state);
    std::vector<std::uint8_t> splits(before, 0);
    parallel_for_ranges(before, elements_at_once, [&](std::size_t begin, std::size_t end) {
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e)
            splits[e] = forest.is_leaf(e) && state.history[e] > 0 && oracle.splits(e);
    });
    for (std::uint32_t e = 0; e < before && forest.size() + 4 <= state.options.refinement.max_elements; ++e)
        if (splits[e]) forest.subdivide(e);
    if (forest.size() == before) return;
    forest.put_in_order(before);
    grow_with_forest(state, before);
    std::fill(state.history.begin() + before, state.history.end(), 0.0f);
}

}  // namespace interflect::inline detail
