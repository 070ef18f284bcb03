#include "interflect/solver/refinement/variance_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/error/error_estimate.h"
#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/refinement/divide_leaves.h"
#include "interflect/solver/refinement/visible_difference.h"
#include "interflect/solver/shrinkage/sibling_variation.h"

namespace interflect::detail {

namespace {

/// Expected ratio of the squared differences among a leaf's children to those among its siblings: 1/4 for linear
/// irradiance, 1/2 at an edge.
constexpr float expected_decay = 0.3f;
/// Assumed squared differences among the children of a patch, relative to its squared irradiance.
constexpr float assumed_square = 0.04f;
/// Minimum expected signal for a split, relative to the children's noise, which shrinkage suppresses at first.
constexpr float min_signal = 0.12f;
/// A leaf is not split if this reduces the total squared error by less than this share.
constexpr double negligible_gain = 2e-7;
/// A leaf is split if it reflects more than this share of the pictures' light from wrong places.
constexpr double negligible_misplacement = 3e-7;
/// The rays of leaves above this share start at hit points (docs/method/method.md, A run). The light behind a slit of 1
/// cm then has an error of at most 6%.
constexpr double tolerable_misplacement = 3e-5;
/// Relative weight of errors on invisible surfaces. It is small because their effect on the view is blurred.
constexpr double invisible_error_weight = 0.02;

class VarianceOracle {
  public:
    explicit VarianceOracle(const SolverState& state)
        : state_(state),
          forest_(*state.light.forest),
          measure_(importance_use(state.light.solution) == ImportanceUse::off ? ErrorMeasure::surfaces
                                                                              : ErrorMeasure::pictures),
          psi_(importance_use(state.light.solution) == ImportanceUse::full
                   ? std::span<const float>(state.light.solution.indirect_importance)
                   : std::span<const float>()) {
        const double reference = reference_power();
        if (state.light.options().refinement.criterion == RefinementCriterion::perceptual && !psi_.empty())
            visible_.emplace(state.inputs, state.light);
        min_misplaced_power_ = (visible_ ? visible_->share_of_light() : negligible_misplacement) * reference;
        max_misplaced_power_ = tolerable_misplacement * reference;
    }

    /// Returns the minimum reduction of the squared error for which a leaf is split [weight times irradiance^2].
    double min_gain() const {
        const double error = estimate_error(state_, measure_).total();
        return std::isfinite(error) ? negligible_gain * error * error * weighted_mean_square() : 0;
    }

    /// Expected mean squared differences of the children from a leaf.
    struct Expected {
        float signal, noise;
    };
    /// Calls body(leaf, expected) for each leaf on all threads. `expected()` returns Expected, which is computed at
    /// most once for four siblings.
    template <class Body>
    void for_each_leaf(const Body& body) const {
        const std::uint32_t roots = forest_.patch_count();
        parallel_for_ranges(roots, elements_per_task, [&](std::size_t begin, std::size_t end) {
            for (PatchIndex e(begin); e < end; ++e)
                if (forest_.is_leaf(e)) body(e, [&] { return expected_in_patch(e); });
        });
        parallel_for_ranges((forest_.size() - roots) / 4, elements_per_task / 4,
                            [&](std::size_t begin, std::size_t end) {
                                for (std::size_t block = begin; block < end; ++block)
                                    for_each_leaf_of_siblings(ElementIndex(roots + 4 * block), body);
                            });
    }

    template <class GetExpected>
    bool splits(ElementIndex leaf, const GetExpected& expected, double min_gain) const {
        // Without importance, both criteria have weight 0.
        if (!psi_.empty() && psi_[leaf] == 0 && state_.light.solution.view_importance[leaf] == 0) return false;
        const auto [signal, noise] = expected();
        if (!(signal > min_signal * noise)) return false;
        const bool is_relevant =
            visible_ ? signal > visible_->threshold(leaf) : weight(leaf) * static_cast<double>(signal) > min_gain;
        const bool blurs = is_relevant && forest_.area(leaf) >= 4 * min_area(state_.inputs, state_.light, leaf);
        const bool misplaces = misplaced_power(leaf, signal) > min_misplaced_power_ &&
                               forest_.area(leaf) >= 4 * state_.inputs.element_floor.default_min_area();
        return blurs || misplaces;
    }

    /// Returns whether a leaf may reflect a significant amount of light from wrong places; true if this is unknown.
    template <class GetExpected>
    bool may_misplace(ElementIndex leaf, const GetExpected& expected) const {
        if (state_.light.history[leaf] == 0 || !state_.light.noise.is_known()) return true;
        if (!psi_.empty() && psi_[leaf] == 0) return false;
        return misplaced_power(leaf, std::max(0.0f, expected().signal)) > max_misplaced_power_;
    }

  private:
    // Children have four times the variance of their parent, of which 3/4 remain in the differences from it.
    Expected expected_in_patch(PatchIndex patch) const {
        const float h = luminance(state_.light.solution.irradiance[patch]);
        return {assumed_square * h * h, 3 * state_.light.noise.variance(forest_, state_.light.solution.irradiance,
                                                                        patch, state_.light.history[patch])};
    }
    Expected expected_below_siblings(ElementIndex first) const {
        const SiblingVariation variation = sibling_variation(state_.light, first);
        return {expected_decay * variation.signal(), 4 * variation.noise};
    }
    template <class Body>
    void for_each_leaf_of_siblings(ElementIndex first, const Body& body) const {
        std::optional<Expected> known;
        const auto expected = [&] {
            if (!known) known = expected_below_siblings(first);
            return *known;
        };
        for (ElementIndex e = first; e < first + 4; ++e)
            if (forest_.is_leaf(e)) body(e, expected);
    }
    double weight(ElementIndex leaf) const {
        double w = error_weight(state_.inputs, state_.light, measure_, leaf);
        if (!psi_.empty()) {
            const double rho = luminance(state_.inputs.materials.reflectance(forest_.patch(leaf), leaf));
            w += invisible_error_weight * rho * rho * static_cast<double>(psi_[leaf]);
        }
        return w * forest_.area(leaf);
    }
    /// Returns the power that the leaf reflects from wrong places [lm or W, times importance].
    double misplaced_power(ElementIndex leaf, float signal) const {
        const double rho = luminance(state_.inputs.materials.reflectance(forest_.patch(leaf), leaf));
        return rho * std::sqrt(static_cast<double>(signal)) * forest_.area(leaf) * (psi_.empty() ? 1.0 : psi_[leaf]);
    }
    double weighted_mean_square() const {
        const double mean = error_reference(state_.inputs, state_.light, measure_);
        double weight = measure_ == ErrorMeasure::surfaces ? 0 : state_.sampling.view.surface_share();
        if (measure_ == ErrorMeasure::surfaces)
            for (PatchIndex i{0}; i < forest_.patch_count(); ++i) weight += forest_.area(i);
        return mean * mean * weight;
    }

    /// Returns the light in the pictures or, without a view, all received power.
    double reference_power() const {
        if (!psi_.empty()) return error_reference(state_.inputs, state_.light, ErrorMeasure::pictures);
        double sum = 0;
        for (PatchIndex i{0}; i < forest_.patch_count(); ++i)
            sum += static_cast<double>(luminance(state_.light.solution.irradiance[i])) * forest_.area(i);
        return sum;
    }

    const SolverState& state_;
    const ElementForest& forest_;
    ErrorMeasure measure_;
    std::optional<VisibleDifference> visible_;                  // only for the perceptual criterion
    std::span<const float> psi_;                                // indirect importance; empty if it is not used
    double min_misplaced_power_ = 0, max_misplaced_power_ = 0;  // [lm or W, times importance]
};

}  // namespace

std::vector<std::uint8_t> leaves_reflecting_where_received(const SolverState& state) {
    if (!refines_by_variance(state.light.options())) return {};
    const VarianceOracle oracle(state);
    std::vector<std::uint8_t> marks(state.light.forest->size(), 0);
    oracle.for_each_leaf([&](ElementIndex e, const auto& expected) { marks[e] = oracle.may_misplace(e, expected); });
    return marks;
}

void refine_by_variance(SolverState& state) {
    const ElementForest& forest = *state.light.forest;
    const VarianceOracle oracle(state);
    const double min_gain = oracle.min_gain();
    std::vector<std::uint8_t> splits(forest.size(), 0);
    oracle.for_each_leaf([&](ElementIndex e, const auto& expected) {
        splits[e] = state.light.history[e] > 0 && oracle.splits(e, expected, min_gain);
    });
    divide_leaves(state, splits);
}

}  // namespace interflect::detail
