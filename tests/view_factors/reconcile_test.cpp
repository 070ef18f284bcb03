// Closure and reciprocity by least squares, against solutions by hand and closed forms.
//
// Seen to fail if averages ignore areas or 1 - F, negative factors are allowed, one multiplier or the variances are
// missing, or the sky does not count in closure.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "interflect/view_factors.h"
#include "tests/support/form_factors.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

const Material absorbing{.name = "black"};

/// A dense matrix of factors with standard errors; without sky, ground and blocked.
ViewFactors dense(const std::vector<double>& areas, const std::vector<std::vector<float>>& values,
                  const std::vector<std::vector<float>>& errors) {
    ViewFactors f;
    f.areas = areas;
    f.names.assign(areas.size(), "");
    f.row_offsets.assign(1, 0);
    for (std::size_t i = 0; i < areas.size(); ++i) {
        for (std::size_t j = 0; j < areas.size(); ++j) {
            if (values[i][j] == 0) continue;
            f.columns.push_back(static_cast<std::int32_t>(j));
            f.values.push_back(values[i][j]);
            f.errors.push_back(errors[i][j]);
        }
        f.row_offsets.push_back(static_cast<std::int64_t>(f.columns.size()));
    }
    for (auto* others : {&f.sky, &f.ground, &f.blocked}) others->assign(areas.size(), 0);
    for (auto* errors_of : {&f.sky_errors, &f.ground_errors, &f.blocked_errors}) errors_of->assign(areas.size(), 1e-6f);
    f.rays_per_group = 1'000'000;
    return f;
}

TEST(Reconcile, DistributesTheRestByVariance) {
    // One row: 0.5 and 0.4 with variances 1 and 4; the missing 0.1 is distributed as 1 to 4.
    ViewFactors f = dense({1, 1}, {{0.5f, 0.4f}, {0.5f, 0.5f}}, {{0.01f, 0.02f}, {0.01f, 0.01f}});
    const Reconciliation result = reconcile(f, {.reciprocity = false});
    EXPECT_NEAR(f.factor(0, 0).value, 0.52, 1e-6);
    EXPECT_NEAR(f.factor(0, 1).value, 0.48, 1e-6);
    EXPECT_NEAR(f.factor(1, 0).value, 0.5, 1e-6);
    EXPECT_NEAR(result.before.closure.largest, 0.1, 1e-6);
    EXPECT_LT(result.after.closure.largest, 1e-6);
}

TEST(Reconcile, AveragesBothDirections) {
    // A_i F_ij: 0.4 and 2 * 0.3. Independent hits have variances in proportion to A_i (1 - F_ij) X, with the common
    // X = (0.4 + 0.3) / (1 + 1/2) = 0.4667: weights 1 / 0.5333 and 1 / (2 * 0.7667).
    ViewFactors f = dense({1, 2}, {{0, 0.4f}, {0.3f, 0}}, {{0, 0.01f}, {0.01f, 0}});
    reconcile(f, {.closure = false});
    const double w = 1 / 0.53333333, v = 1 / (2 * 0.76666667), expected = (w * 0.4 + v * 0.6) / (w + v);
    EXPECT_NEAR(f.factor(0, 1).value, expected, 1e-6);
    EXPECT_NEAR(f.factor(1, 0).value, expected / 2, 1e-6);
    EXPECT_NEAR(f.factor(0, 1).error, std::hypot(w * 0.01, v * 0.02) / (w + v), 1e-6);
}

TEST(Reconcile, KeepsFactorsNonNegative) {
    // The row exceeds 1 by 0.2. Without a bound, the second factor would be negative.
    ViewFactors f = dense({1, 1, 1}, {{1.0f, 0.05f, 0.15f}, {0, 1, 0}, {0, 0, 1}},
                          {{0.01f, 0.1f, 0.1f}, {0, 0.01f, 0}, {0, 0, 0.01f}});
    reconcile(f, {.reciprocity = false});
    EXPECT_EQ(f.factor(0, 1).value, 0);
    EXPECT_NEAR(f.closure(0), 1, 1e-6);
    // The optimum: 0.01^2 : 0.1^2 for the two others, which lose 0.15 together.
    EXPECT_NEAR(f.factor(0, 2).value, 0.15 - 0.15 * 100 / 101, 1e-6);
}

TEST(Reconcile, EnforcesBothLaws) {
    const Scene scene = closed_box({2, 3, 1}, 3, {absorbing});
    const RayCaster ray_caster(scene);
    ViewFactors f = view_factors(scene, ray_caster, facet_groups(scene), {54 << 10});
    const ViewFactors estimate = f;
    const Reconciliation result = reconcile(f);
    EXPECT_GT(result.before.reciprocity.largest, 1e-3);
    EXPECT_LT(result.before.reciprocity.largest_in_errors, 6);
    EXPECT_LT(result.after.reciprocity.largest, 1e-6);
    EXPECT_LT(result.after.closure.largest, 1e-6);
    EXPECT_THAT(f.values, testing::Each(testing::Ge(0.0f)));
    // Closer to the closed forms: two estimates of each pair, and the laws.
    const FormFactors exact = exact_form_factors(scene);
    double squares_before = 0, squares_after = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
        for (std::size_t j = 0; j < f.size(); ++j) {
            squares_before += std::pow(estimate.factor(i, j).value - exact(i, j), 2);
            squares_after += std::pow(f.factor(i, j).value - exact(i, j), 2);
        }
    EXPECT_LT(squares_after, 0.6 * squares_before);
}

TEST(Reconcile, IncludesSkyAndBlockedInClosure) {
    Scene scene = closed_box({1, 1, 1}, 2, {absorbing});
    scene.objects = {"", "walls"};
    for (std::uint32_t p = 0; p < 20; ++p) scene.patches[p].object = 1;  // the ceiling is open
    scene.patches.resize(20);
    std::vector<FaceGroup> groups = facet_groups(scene);
    groups.resize(16);  // the floor only blocks
    const RayCaster ray_caster(scene);
    ViewFactors f = view_factors(scene, ray_caster, groups, {16 << 12});
    const Reconciliation result = reconcile(f);
    EXPECT_LT(result.after.closure.largest, 1e-6);
    EXPECT_LT(result.after.reciprocity.largest, 1e-6);
    EXPECT_GT(f.sky[0], 0.1);
    EXPECT_GT(f.blocked[0], 0.1);
}

TEST(Reconcile, StopsOnRequestWithoutAChange) {
    const Scene scene = closed_box({2, 3, 1}, 2, {absorbing});
    ViewFactors f = view_factors(scene, RayCaster(scene), facet_groups(scene), {24 << 10});
    const ViewFactors estimate = f;
    const std::atomic<bool> stop = true;
    Monitor monitor;
    monitor.stop = &stop;
    EXPECT_THROW(reconcile(f, {}, monitor), Stopped);
    EXPECT_EQ(f.values, estimate.values);
    EXPECT_EQ(f.columns, estimate.columns);
}

}  // namespace
}  // namespace interflect
