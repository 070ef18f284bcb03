// Differences between siblings, on simulated estimates with known truth and noise: the noise found by the model,
// Stein's estimate of the error after shrinkage, merged means, and splits. Statistical tests have fixed seeds; the
// probability of a false alarm is 0.001 each (statistics.h).
//
// Seen to fail (scripts/mutation-test): noise that ignores the number of rays of the iteration, one scale for all
// elements, inner elements without the factor 3/4; risk without its last term, or checked against the mean itself
// instead of the next iteration; differences merged with the tau of the patches; new elements with the full history of
// their parents; a split criterion without noise, or without signal.

#include "interflect/solver/shrinkage/sibling_variation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "interflect/elements/forest.h"
#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/error/finish_solution.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/merge.h"
#include "interflect/solver/refinement/variance_refinement.h"
#include "interflect/solver/transport/received.h"
#include "tests/support/parameter_names.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr double sure = 4;  // standard deviations; a normal variable exceeds this with probability 6e-5

/// Run without rays so far, on a mesh of n x n patches per wall of a cube, each divided `levels` times.
struct Setting {
    Scene scene;
    RayCaster ray_caster;
    SolverState state;
    SolveOptions& options = state.light.solution.options;
    std::mt19937_64 random{1};

    Setting(int n, int levels, float exitance = 1)
        : scene(closed_box({1, 1, 1}, n, {{"wall", Rgb(0.5f), Rgb(exitance)}})),
          ray_caster(scene),
          state(scene, ray_caster, hierarchical()) {
        for (int level = 0; level < levels; ++level) divide();
    }
    static SolveOptions hierarchical() {
        SolveOptions options{.method = find_method("hsrr")};
        return options;
    }
    void divide() {
        const std::uint32_t before = state.light.forest->size();
        for (const ElementIndex leaf : state.light.forest->leaves()) state.light.forest->subdivide(leaf);
        state.light.forest->put_in_order(before);
        grow_with_forest(state, before);
        state.sampling.streams.used.resize(state.light.forest->size());
    }

    /// Simulates an iteration. Siblings differ from their parent by the signal and by noise. Before the siblings' mean
    /// is subtracted, the noise has the variance factor[level] * `variance` / rays on a patch, and four times as much
    /// per level. The model receives the variance without the factor.
    template <class Signal>
    Estimate iteration(float rays, const std::vector<float>& factor, float variance, const Signal& signal) {
        const ElementForest& forest = *state.light.forest;
        Estimate fresh{std::vector<Rgb>(forest.size(), Rgb(0)), std::vector<float>(forest.size(), 0.0f)};
        const auto independent = [&](int level) { return variance / rays * std::pow(4.0f, static_cast<float>(level)); };
        for (ElementIndex e{0}; e < forest.size(); ++e) fresh.variance[e] = independent(forest.level(e));
        std::normal_distribution<float> normal;
        const auto noise = [&](int level) {
            return std::sqrt(factor[static_cast<std::size_t>(level)] * independent(level)) * normal(random);
        };
        for (ElementIndex e{0}; e < forest.patch_count(); ++e) fresh.irradiance[e] = Rgb(1 + noise(0));
        for (ElementIndex first(forest.patch_count()); first < forest.size(); first += 4) {
            std::array<float, 4> difference;
            float mean = 0;
            for (float& d : difference) mean += (d = noise(forest.level(first))) / 4;
            for (std::uint32_t k = 0; k < 4; ++k)
                fresh.irradiance[first + k] =
                    fresh.irradiance[forest.parent(first)] + Rgb(difference[k] - mean + signal(first, k));
        }
        return fresh;
    }
    template <class Signal>
    void iterate(float rays, const std::vector<float>& factor, float variance, const Signal& signal) {
        const Estimate fresh = iteration(rays, factor, variance, signal);
        const TracedIteration iteration{
            {.rays = static_cast<std::int64_t>(rays), .old_elements = state.light.forest->size()}};
        estimate_noise(state, fresh, iteration.weight);
        merge_independent(state.light, state.light.solution.irradiance, fresh.irradiance, iteration);
        update_history(state.light, iteration);
    }
};

constexpr auto no_signal = [](std::uint32_t, std::uint32_t) { return 0.0f; };

TEST(NoiseModel, FindsHowMuchMoreOrLessNoiseThereIsWhereFewerRaysArrive) {
    Setting s(10, 2);  // 600 patches with 2400 and 9600 descendants; one ray in 2, 8 and 32 hits them
    const std::vector<float> factor{3, 1, 0.1f};
    constexpr float variance = 3;  // of one ray on a patch
    for (int k = 0; k < 12; ++k) {
        EXPECT_EQ(s.state.light.noise.is_known(), k > 1) << k;
        s.iterate(1e5f * static_cast<float>(1 + k), factor, variance, no_signal);
    }
    const std::array<std::uint32_t, 3> first{0, 600, 3000};
    for (std::size_t level = 0; level < 3; ++level) {
        // Three of four siblings are independent. Four iterations count, by the decay of the model's history.
        const double expected = variance * std::pow(4.0, level) * factor[level] * (level == 0 ? 1 : 0.75);
        const double freedom = 4.0 * (level == 0 ? 600 : 0.75 * (level == 1 ? 2400 : 9600));
        const double found = s.state.light.noise.variance(*s.state.light.forest, s.state.light.solution.irradiance,
                                                          ElementIndex(first[level]), 1);
        EXPECT_NEAR(found / expected, 1, sure * std::sqrt(2 / freedom)) << "level " << level;
        EXPECT_GT(std::abs(found / (1.5 * expected) - 1), sure * std::sqrt(2 / freedom)) << "would notice a half more";
        const double with_ten = s.state.light.noise.variance(*s.state.light.forest, s.state.light.solution.irradiance,
                                                             ElementIndex(first[level]), 10);
        EXPECT_NEAR(with_ten / found, 0.1, 1e-5) << "falls with the rays";
    }
}

/// Returns the mean squared error of the shrunk differences over all siblings, given the true `signal`.
template <class Signal>
double true_risk(const Setting& s, const Signal& signal) {
    const ElementForest& forest = *s.state.light.forest;
    double sum = 0, groups = 0;
    for (ElementIndex first(forest.patch_count()); first < forest.size(); first += 4, ++groups)
        for (std::uint32_t k = 0; k < 4; ++k) {
            const float y = luminance(s.state.light.solution.irradiance[first + k]) -
                            luminance(s.state.light.solution.irradiance[forest.parent(first)]);
            sum +=
                std::pow(sibling_variation(s.state.light, ElementIndex(first)).shrinkage() * y - signal(first, k), 2) /
                4;
        }
    return sum / groups;
}

TEST(RiskCheck, MeasuresTheErrorOfReducedDifferences) {
    Setting s(20, 1);  // 2400 patches, each divided once
    const auto signal = [](std::uint32_t, std::uint32_t k) { return k < 2 ? 0.02f : -0.02f; };
    for (int k = 0; k < 4; ++k) s.iterate(1000, {0, 1}, 0.1f, signal);
    double measured = 0, expected = 0, found_signal = 0;
    for (int k = 0; k < 8; ++k) {
        const double risk = 6 * true_risk(s, signal);  // times the area of the walls [m^2]
        s.state.light.risk_check = {};
        s.iterate(1000, {0, 1}, 0.1f, signal);
        measured += s.state.light.risk_check.measured / risk / 8;
        expected += s.state.light.risk_check.expected / risk / 8;
        found_signal += s.state.light.risk_check.signal / s.state.light.risk_check.weight / 8;
    }
    // 2400 products, with noise of four times the risk. Each of the eight iterations shares most data with the next.
    EXPECT_NEAR(measured, 1, 0.1);
    EXPECT_NEAR(expected, 1, 0.1);
    EXPECT_NEAR(found_signal / (6 * 0.02 * 0.02), 1, 0.1);
}

TEST(ErrorWeight, IsBoundedByTheReflectanceWhateverColourNoiseGivesTheLight) {
    const Rgb rho(0.8f, 0.1f, 0.4f);
    const Scene scene = closed_box({1, 1, 1}, 1, {{"wall", rho, Rgb(1)}});
    const RayCaster ray_caster(scene);
    SolveOptions options = Setting::hierarchical();
    options.views.push_back({{"", {0.5, 0.5, 0.5}, {1, 0.5, 0.5}}});
    interflect::SolverState state(scene, ray_caster, options);
    state.light.solution.view_importance.assign(state.light.forest->size(), 1.0f);
    state.light.solution.irradiance[0] = {3, -0.89f, 0.2f};  // luminance 0.02; the reflected light has 0.4
    EXPECT_LE(error_weight(state.inputs, state.light, ErrorMeasure::pictures, ElementIndex(0)), 0.8 * 0.8);
    EXPECT_GE(error_weight(state.inputs, state.light, ErrorMeasure::pictures, ElementIndex(0)), 0.1 * 0.1);
}

class Risk : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(SignalToNoise, Risk, testing::Values(0.0, 0.5, 1.0, 2.0, 5.0), printed_name);

TEST_P(Risk, IsTheMeanSquareErrorThatIsLeft) {
    constexpr int trials = 200'000;
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    const double a = GetParam();  // in units of the noise
    const std::array<double, 4> signal{a, a, -a, -a};
    std::vector<double> differences, without_last_term;
    double mean_error = 0, mean_unreduced = 0;
    for (int t = 0; t < trials; ++t) {
        std::array<double, 4> y;
        double mean = 0, spread = 0, error = 0;
        for (double& x : y) mean += (x = normal(random)) / 4;
        for (std::size_t k = 0; k < 4; ++k) {
            y[k] += signal[k] - mean;
            spread += y[k] * y[k] / 4;
            mean_unreduced += std::pow(y[k] - signal[k], 2) / (4 * trials);
        }
        const SiblingVariation detail{static_cast<float>(spread), 0.75f};
        for (std::size_t k = 0; k < 4; ++k)
            error += std::pow(static_cast<double>(detail.shrinkage()) * y[k] - signal[k], 2) / 4;
        differences.push_back(static_cast<double>(detail.risk()) - error);
        without_last_term.push_back(static_cast<double>(std::min(detail.noise, detail.signal())) - error);
        mean_error += error / trials;
    }
    EXPECT_GT(t_test(differences, 0), false_alarm);
    EXPECT_LT(t_test(differences, 0.05 * mean_error), false_alarm) << "would notice five percent";
    EXPECT_LT(t_test(without_last_term, 0), false_alarm);
    if (a < 1) {
        EXPECT_LT(mean_error, 0.8 * mean_unreduced) << "reduction helps where there is little signal";
    }
}

TEST(MergeDetails, KeepsTheMeansOfParentsWhateverTheHistoryOfTheirChildren) {
    Setting s(2, 2);
    std::uniform_real_distribution<float> history(0, 1000);
    for (int k = 0; k < 5; ++k) {
        s.state.light.history.change([&](ElementIndex, float) { return history(s.random); });
        const Estimate fresh = s.iteration(100, {1, 1, 1}, 2, no_signal);
        merge_independent(s.state.light, s.state.light.solution.irradiance, fresh.irradiance, {.plan = {.rays = 100}});
    }
    std::vector<Rgb> means = s.state.light.solution.irradiance;
    pull(*s.state.light.forest, means);
    for (ElementIndex e{0}; e < means.size(); ++e)
        EXPECT_NEAR(means[e].x, s.state.light.solution.irradiance[e].x, 1e-5f) << e;
}

/// Returns estimates for siblings, one per trial. Only the first sibling is lit, and each of its samples is either 0 or
/// large. `merges` merges of 100 rays follow.
/// @param before  Rays that patches received earlier.
template <class Merge>
std::array<std::vector<double>, 4> lone_bright_siblings(float before, int merges, const Merge& merge_one) {
    Setting s(1, 1);
    std::array<std::vector<double>, 4> found;
    std::bernoulli_distribution hit(0.2);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<Rgb>& mean = s.state.light.solution.irradiance;
        mean.assign(mean.size(), Rgb(1));  // inherited; the truth is 4 for the first sibling, 0 for the others
        for (ElementIndex e{0}; e < mean.size(); ++e) s.state.light.history.set(e, e < 6 ? before : 0.0f);
        s.state.light.noise = NoiseModel(mean.size());
        for (int k = 0; k < merges; ++k) {
            Estimate fresh{std::vector<Rgb>(mean.size(), Rgb(0)), std::vector<float>(mean.size(), 0.0f)};
            for (ElementIndex first{6}; first < mean.size(); first += 4) {
                fresh.irradiance[first] = Rgb(hit(s.random) ? 20 : 0);
                fresh.variance[first] = fresh.irradiance[first].x * fresh.irradiance[first].x;
            }
            pull(*s.state.light.forest, fresh.irradiance);
            pull_variance(*s.state.light.forest, fresh.variance);
            const TracedIteration iteration{{.rays = 100, .old_elements = s.state.light.forest->size()}};
            estimate_noise(s.state, fresh, iteration.weight);
            merge_one(s.state, mean, fresh.irradiance, iteration);
            update_history(s.state.light, iteration);
        }
        for (std::uint32_t k = 0; k < 4; ++k) found[k].push_back(mean[6 + k].x);
    }
    return found;
}

TEST(MergeDetails, IsUnbiasedForYoungSiblings) {
    const auto merged = lone_bright_siblings(
        1000, 2, [](const interflect::SolverState& state, auto&&... a) { merge_independent(state.light, a...); });
    const auto scaled = lone_bright_siblings(
        1000, 2, [](const interflect::SolverState& state, auto&&... a) { merge(state.light, a...); });
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_GT(4 * t_test(merged[k], k == 0 ? 4 : 0), false_alarm) << k;
        EXPECT_LT(4 * t_test(merged[k], k == 0 ? 4.3 : 0.3), false_alarm) << k << ": would notice 0.3";
        EXPECT_LT(4 * t_test(scaled[k], k == 0 ? 4 : 0), false_alarm) << k << ": scaling is biased";
    }
}

/// The parent's mean has more rays than its children's. Seen to fail if all siblings take the same part of the
/// difference: the dark ones then vary by 0.2 between trials. The shares depend on the
/// data, so estimates are biased, here by 1.5% of the bright sibling after 20 contributions; their mean is not.
TEST(MergeDetails, DoesNotSpreadTheNoiseOfABrightSiblingToDarkOnes) {
    RELEASE_ONLY();  // see MergeDetails.IsUnbiasedForYoungSiblings
    const auto merged = lone_bright_siblings(
        1e6f, 100, [](const interflect::SolverState& state, auto&&... a) { merge_independent(state.light, a...); });
    for (std::size_t k = 0; k < 4; ++k) {
        double mean = 0, square = 0;
        for (const double x : merged[k]) {
            mean += x / 2000;
            square += x * x / 2000;
        }
        EXPECT_NEAR(mean, k == 0 ? 4 : 0, k == 0 ? 0.1 : 0.04) << k;
        if (k > 0) {
            EXPECT_LT(std::sqrt(square - mean * mean), 0.14) << k;
        }
    }
}

/// One sibling is lit, with a noise of 10% in each of 20 iterations. Seen to fail, by a factor of 5, if the differences
/// of all four shrink by the same factor.
TEST(Shrinkage, LeavesADarkSiblingDark) {
    Setting s(1, 1);
    std::normal_distribution<float> normal(4, 0.4f);
    const TracedIteration iteration{{.rays = 100, .old_elements = s.state.light.forest->size()}};
    for (int k = 0; k < 20; ++k) {
        Estimate fresh{std::vector<Rgb>(30, Rgb(0)), std::vector<float>(30, 0.0f)};
        for (ElementIndex first{6}; first < 30; first += 4) {
            fresh.irradiance[first] = Rgb(normal(s.random));
            fresh.variance[first] = 0.16f;
        }
        pull(*s.state.light.forest, fresh.irradiance);
        pull_variance(*s.state.light.forest, fresh.variance);
        estimate_noise(s.state, fresh, iteration.weight);
        merge_independent(s.state.light, s.state.light.solution.irradiance, fresh.irradiance, iteration);
        update_history(s.state.light, iteration);
    }
    finish_solution(s.state);
    for (ElementIndex e(6); e < 30; ++e)
        EXPECT_NEAR(s.state.light.solution.irradiance[e].x, e % 4 == 2 ? 4 : 0, e % 4 == 2 ? 0.5 : 1e-4);
}

TEST(InheritedTrust, DecidesWhetherALeafThatRaysMissedGoesDark) {
    constexpr std::uint32_t patches = 6;
    const TracedIteration iteration{{.rays = 100, .old_elements = patches}};
    for (const float trust : {0.0f, 0.1f, 1.0f}) {
        Setting s(1, 1);
        s.options.experimental.inherited_weight = trust;
        std::vector<Rgb>& mean = s.state.light.solution.irradiance;
        mean.assign(mean.size(), Rgb(1));
        update_history(s.state.light, iteration);  // after one iteration, which created the elements below the patches
        std::vector<Rgb> received(mean.size(), Rgb(4.0f / 3));
        for (ElementIndex e(patches); e < mean.size(); e += 4) received[e] = Rgb(0);  // rays missed it
        pull(*s.state.light.forest, received);
        merge(s.state.light, mean, received, iteration);
        EXPECT_NEAR(mean[0].x, 1, 1e-6) << "of light none is lost";
        const float missed = trust / (1 + trust), others = (trust + 4.0f / 3) / (1 + trust);
        EXPECT_NEAR(mean[patches].x, missed, 1e-5);
        EXPECT_NEAR(mean[patches + 1].x, others, 1e-5);
    }
}

/// Returns the share of leaves split after iterations with unit noise and this signal.
template <class Signal>
double share_split(const Signal& signal) {
    Setting s(10, 1);
    for (int k = 0; k < 6; ++k) s.iterate(1000, {1, 1}, 10, signal);
    const auto leaves = static_cast<double>(s.state.light.forest->leaves().size());
    const std::uint32_t before = s.state.light.forest->size();
    refine_by_variance(s.state);
    for (ElementIndex e(before); e < s.state.light.forest->size(); ++e)
        EXPECT_EQ(s.state.light.history[e], 0) << "measured anew";
    return (s.state.light.forest->size() - before) / 4 / leaves;
}

TEST(VarianceRefinement, SeldomSplitsPureNoise) {
    // Siblings are split if spread / noise > 1 + 0.12 * 4 / 0.3 = 2.6. Three times this ratio is chi-square with three
    // degrees of freedom, and exceeds 7.8 with probability 0.0503. 4 standard deviations of 600 groups of siblings are
    // 0.036.
    const double share = share_split(no_signal);
    EXPECT_NEAR(share, 0.0503, 0.036);
}

// Seen to fail with an infinite result: the square of the noise exceeds single precision.
TEST(SiblingVariation, RiskGoesWithTheUnit) {
    const auto risk = [](float unit) { return SiblingVariation{.spread = 3 * unit, .noise = 2 * unit}.risk() / unit; };
    EXPECT_FLOAT_EQ(risk(1e25f), risk(1));
    EXPECT_FLOAT_EQ(risk(1e-25f), risk(1));
}

TEST(VarianceRefinement, SplitsAtAShadowEdge) {
    // After six iterations, the noise of a difference has the variance 0.75 * 10 / 6000 = 0.035^2.
    EXPECT_EQ(share_split([](std::uint32_t, std::uint32_t k) { return k < 2 ? 0.3f : -0.3f; }), 1);
    const auto in_half = [](std::uint32_t first, std::uint32_t k) {
        return first / 4 % 2 == 0 ? 0.0f : k < 2 ? 0.3f : -0.3f;
    };
    EXPECT_NEAR(share_split(in_half), 0.525, 0.03) << "and nowhere else";
}

TEST(VarianceRefinement, KeepsItsLimitsAndLeavesWhatIsMeasuredTooLittle) {
    Setting s(4, 1);
    const auto edge = [](std::uint32_t, std::uint32_t k) { return k < 2 ? 0.3f : -0.3f; };
    for (int k = 0; k < 4; ++k) s.iterate(1000, {1, 1}, 10, edge);
    s.options.refinement.max_elements = s.state.light.forest->size() + 21;
    const std::uint32_t before = s.state.light.forest->size();
    refine_by_variance(s.state);
    EXPECT_EQ(s.state.light.forest->size(), before + 20);
    s.options.refinement.max_elements = 1 << 20;
    s.state.light.history.assign(s.state.light.history.size(), 0);
    const std::uint32_t then = s.state.light.forest->size();
    refine_by_variance(s.state);
    EXPECT_EQ(s.state.light.forest->size(), then) << "nothing was measured";
}

}  // namespace
}  // namespace interflect
