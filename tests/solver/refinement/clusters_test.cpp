// Clusters of patches: the trees, and the differences between patches that they reduce, on simulated estimates with
// known truth and noise, of fixed seeds.
//
// Seen to fail (scripts/mutation-test): differences that are never reduced; noise by the measured variance alone;
// an error without its bias; parts that do not share the loss of their mean.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "interflect/elements/forest.h"
#include "interflect/solver/clusters/patch_clusters.h"
#include "interflect/solver/error/finish_solution.h"
#include "interflect/solver/shrinkage/cluster_shrinkage.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// A box of 600 patches, of which each receives `payload` by a Poisson number of rays.
struct Box {
    static constexpr float payload = 0.004f;  // [lm]

    float size;
    Scene scene = closed_box({size, size, size}, 10, {{"wall", Rgb(0.5f), Rgb(1)}});
    RayCaster ray_caster{scene};
    SolverState state{scene, ray_caster, {.method = find_method("hsrr")}};
    std::mt19937_64 random{1};

    explicit Box(float s = 1) : size(s) {}
    std::uint32_t patches() const { return state.light.forest->patch_count(); }
    float area(std::uint32_t p) const { return state.light.forest->area(ElementIndex(p)); }

    /// Returns 0 to 5.
    int wall(std::uint32_t p) const {
        const V3f n = state.light.forest->geometry(PatchIndex(p)).normal();
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(n[axis]) > 0.5f) return 2 * axis + (n[axis] > 0 ? 1 : 0);
        return -1;
    }

    void receive(const std::function<float(std::uint32_t)>& truth) {
        std::vector<float> variance(patches());
        state.light.history.assign(patches(), 1.0f);
        for (std::uint32_t p = 0; p < patches(); ++p) {
            std::poisson_distribution<int> rays(static_cast<double>(truth(p) * area(p) / payload));
            const auto hits = static_cast<float>(rays(random));
            state.light.solution.irradiance[p] = Rgb(hits * payload / area(p));
            variance[p] = hits * payload * payload / (area(p) * area(p));
        }
        state.light.noise.set_variance(variance, state.light.history);
    }

    double squared_error(const std::vector<Rgb>& irradiance, const std::function<float(std::uint32_t)>& truth) const {
        double sum = 0;
        for (std::uint32_t p = 0; p < patches(); ++p)
            sum += static_cast<double>(area(p)) * std::pow(luminance(irradiance[p]) - truth(p), 2);
        return sum / (6 * size * size);
    }
    double mean(const std::vector<Rgb>& irradiance) const {
        double sum = 0;
        for (std::uint32_t p = 0; p < patches(); ++p) sum += static_cast<double>(area(p) * luminance(irradiance[p]));
        return sum / (6 * size * size);
    }
};

TEST(PatchClusters, ContainEveryPatchOnceInGroupsOfTwoToThirtyOne) {
    const Box box;
    for (const PatchClusters& clusters : box.state.inputs.clusters) {
        std::multiset<std::uint32_t> found;
        for (std::size_t i = 0; i < clusters.nodes().size(); ++i) {
            const PatchClusters::Node& node = clusters.nodes()[i];
            if (node.is_patch()) {
                found.insert(node.patch);
                continue;
            }
            EXPECT_GT(node.first_child, i) << "parents come first";
            EXPECT_GE(node.child_count, 2u);
            EXPECT_LE(node.child_count, PatchClusters::most_parts);
        }
        ASSERT_EQ(found.size(), 600u);
        EXPECT_EQ(std::set<std::uint32_t>(found.begin(), found.end()).size(), 600u);
    }
}

TEST(PatchClusters, SeparateDirections) {
    const Box box;
    const PatchClusters& clusters = box.state.inputs.clusters.front();
    int mixed = 0, all = 0;
    for (const PatchClusters::Node& node : clusters.nodes()) {
        if (node.is_patch() || !clusters.nodes()[node.first_child].is_patch()) continue;
        std::set<int> walls;
        for (std::uint32_t k = 0; k < node.child_count; ++k)
            walls.insert(box.wall(clusters.nodes()[node.first_child + k].patch));
        ++all;
        mixed += walls.size() > 1;
    }
    EXPECT_LE(mixed, all / 4) << "of the smallest clusters";
}

TEST(PatchClusters, AreTheSameInAnyUnitOfLength) {
    const Box metres(1), kilometres(1024);
    for (std::size_t tree = 0; tree < metres.state.inputs.clusters.size(); ++tree) {
        const auto a = metres.state.inputs.clusters[tree].nodes(), b = kilometres.state.inputs.clusters[tree].nodes();
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            ASSERT_EQ(a[i].child_count, b[i].child_count) << "tree " << tree << ", node " << i;
            ASSERT_EQ(a[i].patch, b[i].patch) << "tree " << tree << ", node " << i;
        }
    }
}

TEST(PatchClusters, AreNotMadeWithoutShrinkage) {
    const Scene scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(1)}});
    const RayCaster ray_caster(scene);
    SolveOptions options{.method = find_method("hsrr")};
    EXPECT_FALSE(SolverState(scene, ray_caster, options).inputs.clusters.empty());
    options.experimental.clusters = false;
    EXPECT_TRUE(SolverState(scene, ray_caster, options).inputs.clusters.empty());
    options.experimental = {.shrinkage = false};
    EXPECT_TRUE(SolverState(scene, ray_caster, options).inputs.clusters.empty());
    EXPECT_TRUE(SolverState(scene, ray_caster, {.method = find_method("srr")}).inputs.clusters.empty())
        << "does not refine";
}

TEST(ClusterShrinkage, RemovesNearlyAllNoiseFromEqualPatches) {
    Box box;
    const auto truth = [](std::uint32_t) { return 2.0f; };  // five rays on each patch
    box.receive(truth);
    const double before = box.squared_error(box.state.light.solution.irradiance, truth),
                 mean = box.mean(box.state.light.solution.irradiance);
    finish_solution(box.state);
    EXPECT_LT(box.squared_error(box.state.light.solution.irradiance, truth), before / 10);
    EXPECT_NEAR(box.mean(box.state.light.solution.irradiance) / mean, 1, 1e-5) << "no light is lost";
    for (const Rgb& h : box.state.light.solution.irradiance) ASSERT_GE(h.x, 0);
}

TEST(ClusterShrinkage, KeepsShadowsDark) {
    Box box;
    const auto truth = [&](std::uint32_t p) { return box.wall(p) == 2 ? 0.0f : 200.0f; };  // 500 rays
    box.receive(truth);
    finish_solution(box.state);
    for (std::uint32_t p = 0; p < box.patches(); ++p) {
        if (box.wall(p) == 2) {
            EXPECT_LT(box.state.light.solution.irradiance[p].x, 1) << p;
        }
    }
}

TEST(ClusterShrinkage, LightsPatchesThatNoRayHasHit) {
    Box box;
    const auto truth = [](std::uint32_t) { return 0.4f; };  // one ray on each patch
    box.receive(truth);
    const auto is_black = [](const Rgb& h) { return h.x == 0; };
    ASSERT_GT(std::ranges::count_if(box.state.light.solution.irradiance, is_black), 150);
    finish_solution(box.state);
    for (const Rgb& h : box.state.light.solution.irradiance) ASSERT_GT(h.x, 0.1f);
}

/// Outliers, on one wall a thousand times brighter, do not spread to precise patches. Seen to fail with 700 errors
/// without the limit.
TEST(ClusterShrinkage, MovesNoPatchByMoreThanThreeStandardErrors) {
    Box box;
    box.state.light.history.assign(box.patches(), 1.0f);
    std::vector<float> before(box.patches()), error(box.patches()), variance(box.patches());
    for (std::uint32_t p = 0; p < box.patches(); ++p) {
        const bool is_bright = box.wall(p) == 2, is_outlier = p % 30 == 0;
        const float value = is_bright ? 3000 : 1;
        error[p] = is_outlier ? 400 * std::sqrt(value) : 0.02f * value;
        before[p] = (is_outlier ? 500 : 1) * value + 0.02f * value * std::normal_distribution<float>()(box.random);
        box.state.light.solution.irradiance[p] = Rgb(before[p]);
        variance[p] = error[p] * error[p];
    }
    box.state.light.noise.set_variance(variance, box.state.light.history);
    const double mean = box.mean(box.state.light.solution.irradiance);
    finish_solution(box.state);
    for (std::uint32_t p = 0; p < box.patches(); ++p)
        EXPECT_LE(std::abs(box.state.light.solution.irradiance[p].x - before[p]), 3.3f * error[p]) << p;
    EXPECT_NEAR(box.mean(box.state.light.solution.irradiance) / mean, 1, 1e-4) << "no light is lost";
}

// So it is after an iteration that found light on some patches for the first time. Seen to fail (NaN) when their
// payload counts as 0.
TEST(ClusterShrinkage, AcceptsPatchesWhoseNoiseIsNotKnownYet) {
    Box box;
    box.receive([](std::uint32_t) { return 2.0f; });
    std::vector<float> variance(box.patches());
    for (std::uint32_t p = 0; p < box.patches(); p += 2) variance[p] = 2 * Box::payload / box.area(p);
    box.state.light.noise.set_variance(variance, box.state.light.history);
    finish_solution(box.state);
    for (std::uint32_t p = 0; p < box.patches(); ++p) {
        ASSERT_TRUE(std::isfinite(box.state.light.solution.irradiance[p].x)) << p;
        ASSERT_TRUE(std::isfinite(box.state.light.solution.standard_error[p])) << p;
    }
}

class ClusterRisk : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Contrast, ClusterRisk, testing::Values(0.0f, 0.2f, 0.5f, 1.0f), printed_name);

TEST_P(ClusterRisk, IsAboutTheErrorThatIsLeft) {
    Box box;
    const auto truth = [&](std::uint32_t p) {  // 25 rays a patch; varies over each wall
        const PatchGeometry& geometry = box.state.light.forest->geometry(PatchIndex(p));
        return 10 *
               (1 + GetParam() * std::sin(6 * geometry.point({0.5f, 0.5f}).x + 4 * geometry.point({0.5f, 0.5f}).y));
    };
    constexpr int trials = 400;
    double estimated = 0, of_noise = 0, error = 0;
    for (int trial = 0; trial < trials; ++trial) {
        box.receive(truth);
        const ClusterShrinkage shrinkage(box.state.light, box.state.inputs.clusters.front(),
                                         box.state.light.solution.irradiance);
        std::vector<ClusterShrinkage::Errors> errors(box.patches());
        shrinkage.measure_errors(errors, [](std::size_t) { return 1.0f; });
        for (std::uint32_t p = 0; p < box.patches(); ++p) {
            estimated += static_cast<double>(box.area(p) * (errors[p].noise + errors[p].bias)) / 6;
            of_noise += static_cast<double>(box.area(p) * errors[p].noise) / 6;
        }
        error += box.squared_error(shrinkage.means(box.state.sampling.view.rays()), truth);
    }
    EXPECT_GT(std::sqrt(estimated / error), 0.85);
    EXPECT_LT(std::sqrt(estimated / error), 1.3);
    EXPECT_LT(std::sqrt(of_noise / error), 0.82) << "without bias";
}

TEST(ClusterShrinkage, KeepsTheMeanOfPicturesThatShowTheBrightPatches) {
    Box box;
    box.state.light.solution.options.views = {{{"", {0.5, 0.5, 0.5}, {1, 0.5, 0.5}}}};
    compute_view_importance(box.state);
    std::vector<float>& seen = box.state.light.solution.view_importance;
    for (std::uint32_t p = 0; p < box.patches(); ++p) seen[p] = p % 2 == 0 ? 1 / 3.0f : 0;
    const auto truth = [](std::uint32_t p) { return p % 2 == 0 ? 2.2f : 1.8f; };  // five rays on each patch
    box.receive(truth);
    const auto mean_of = [&](std::uint32_t parity) {
        double sum = 0;
        for (std::uint32_t p = parity; p < box.patches(); p += 2)
            sum += static_cast<double>(box.area(p) * luminance(box.state.light.solution.irradiance[p]));
        return sum / 3;
    };
    const double seen_before = mean_of(0), hidden_before = mean_of(1),
                 error = box.squared_error(box.state.light.solution.irradiance, truth);
    finish_solution(box.state);
    EXPECT_NEAR(mean_of(0) / seen_before, 1, 0.01);
    EXPECT_NEAR((mean_of(0) + mean_of(1)) / (seen_before + hidden_before), 1, 0.01) << "power";
    EXPECT_LT(box.squared_error(box.state.light.solution.irradiance, truth), error / 3);
}

TEST(ClusterShrinkage, KeepsTheSumOfLightGroups) {
    Scene scene = closed_box({1, 1, 1}, 10, {{"wall", Rgb(0.5f), Rgb(1)}});
    scene.light_groups = {{"lamps", "wall"}};
    const RayCaster ray_caster(scene);
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 3000;
    const Solution solution = solve(scene, ray_caster, options);
    for (std::size_t e = 0; e < solution.irradiance.size(); ++e) {
        Rgb sum(0);
        for (const std::vector<Rgb>& of_group : solution.groups) sum += of_group[e];
        ASSERT_NEAR(sum.x, solution.irradiance[e].x, 1e-4f * solution.irradiance[e].x + 1e-6f);
    }
}

}  // namespace
}  // namespace interflect
