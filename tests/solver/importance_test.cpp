// View importance: the adjoint of light. What a view measures is the same from either end, sum v P = sum psi W, and in
// a closed grey box the importance of everything is what was received straight from the eye over 1 - rho.

#include <gtest/gtest.h>

#include <cmath>

#include "interflect/solver/solve.h"
#include "interflect/solver/surfaces.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

/// A grey box of 1 x 2 x 3 m, 3 x 3 patches a wall, each wall with a reflectance of its own; the ceiling shines.
Scene grey_box() {
    std::vector<Material> walls;
    for (const float rho : {0.2f, 0.7f, 0.5f, 0.4f, 0.8f, 0.3f}) walls.push_back({"wall", Rgb(rho), Rgb(0)});
    walls[5].exitance = Rgb(10);
    return closed_box({1, 2, 3}, 3, walls);
}

/// Sees parts of three walls, not the one that shines.
const View into_the_corner{"corner", {0.9f, 1.9f, 2.5f}, {0.1f, 0.4f, 0.2f}, {0, 0, 1}, 40};

SolveOptions options_for(const char* method, std::uint64_t seed) {
    SolveOptions options;
    options.method = find_method(method);
    options.views = {{into_the_corner}};
    options.rays = 200'000;
    options.seed = seed;
    return options;
}

double sum_over_leaves(const Solution& s, const std::vector<float>& per_area) {
    double sum = 0;
    for (const std::uint32_t e : s.forest->leaves()) sum += static_cast<double>(per_area[e]) * s.forest->area(e);
    return sum;
}

/// sum v P: what the view measures, from the light.
double measured_by_light(const Scene& scene, const Solution& s) {
    const std::vector<Rgb> b = radiosity(Surfaces(scene), *s.forest, s.irradiance);
    double sum = 0;
    for (const std::uint32_t e : s.forest->leaves())
        sum += static_cast<double>(s.view_importance[e]) * s.forest->area(e) * b[e].x;
    return sum;
}

/// sum psi W: the same, from the importance of the emitters.
double measured_by_importance(const Scene& scene, const Solution& s) {
    double sum = 0;
    for (const std::uint32_t e : s.forest->leaves())
        sum += static_cast<double>(s.view_importance[e] + s.indirect_importance[e]) * s.forest->area(e) *
               Surfaces(scene).exitance(s.forest->patch(e)).x;
    return sum;
}

TEST(Importance, OfTheViewSumsToOne) {
    const Scene scene = grey_box();
    const Solution s = solve(scene, RayCaster(scene), options_for("ihsrr", 1));
    EXPECT_NEAR(sum_over_leaves(s, s.view_importance), 1, 1e-4);
    for (std::uint32_t patch = 45; patch < 54; ++patch)
        EXPECT_EQ(s.view_importance[patch], 0) << "the ceiling is not seen";
}

TEST(Importance, InAClosedGreyBoxIsViewImportanceOverOneMinusRho) {
    // Equal quanta in a closed box: no statistics; what is left is the end of the start and the last merge.
    for (const float rho : {0.0f, 0.5f, 0.8f}) {
        const Scene scene = closed_box({1, 2, 3}, 3, {{"grey", Rgb(rho), Rgb(1)}});
        SolveOptions options = options_for("isrr", 1);
        options.separate_iterations = true;  // then all rays of an importance step carry the same importance
        const Solution s = solve(scene, RayCaster(scene), options);
        const double indirect = rho / (1 - rho);
        EXPECT_NEAR(sum_over_leaves(s, s.indirect_importance), indirect, 0.02 * indirect) << "rho " << rho;
    }
}

struct Variant {
    const char* method;
    bool separate, at_elements;
};

class Duality : public testing::TestWithParam<Variant> {};

TEST_P(Duality, LightAndImportanceMeasureTheSame) {
    constexpr int runs = 16;
    const Scene scene = grey_box();
    const RayCaster ray_caster(scene);
    std::vector<double> differences;
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        SolveOptions options = options_for(GetParam().method, seed);
        options.epsilon = 1e-5;  // so fine that what the mesh smooths away is below what the test can notice
        options.separate_iterations = GetParam().separate;
        options.importance_at_elements = GetParam().at_elements;
        const Solution s = solve(scene, ray_caster, options);
        ASSERT_EQ(s.non_finite, 0);
        const double light = measured_by_light(scene, s);
        differences.push_back(light - measured_by_importance(scene, s));
        mean += light / runs;
    }
    // The start leaves out 0.1% of the light and up to 2% of the importance, of which later iterations make up most.
    const double truncated = 0.01 * mean;
    EXPECT_GT(t_test(differences, 0, truncated / 3), false_alarm);
    EXPECT_LT(t_test(differences, 0.05 * mean, truncated / 3), false_alarm) << "would notice five percent";
}

INSTANTIATE_TEST_SUITE_P(Variants, Duality,
                         testing::Values(Variant{"isrr", true, true}, Variant{"isrr", false, true},
                                         Variant{"ihsrr", true, true}, Variant{"ihsrr", false, true},
                                         Variant{"ihsrr", true, false}, Variant{"ihsrr", false, false}),
                         [](const auto& test) {
                             return std::string(test.param.method) + (test.param.separate ? "_si" : "_ci") +
                                    (test.param.at_elements ? "_hi" : "");
                         });

}  // namespace
}  // namespace interflect
