// View importance, the adjoint of light. Both transports measure the same for a view: sum v P = sum psi W. In a closed
// grey box, total importance is the importance received directly from the camera over 1 - rho.

#include <gtest/gtest.h>

#include <cmath>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// Returns a grey box of 1 x 2 x 3 m with 3 x 3 patches per wall. Each wall has its own reflectance; the ceiling emits.
Scene grey_box() {
    std::vector<Material> walls;
    for (const float rho : {0.2f, 0.7f, 0.5f, 0.4f, 0.8f, 0.3f}) walls.push_back({"wall", Rgb(rho), Rgb(0)});
    walls[5].exitance = Rgb(10);
    return closed_box({1, 2, 3}, 3, walls);
}

SolveOptions options_for(const char* method, std::uint64_t seed) {
    SolveOptions options{.method = find_method(method)};
    options.views = {{into_the_corner}};
    options.limits.rays = 200'000;
    options.seed = seed;
    return options;
}

double sum_over_leaves(const Solution& s, const std::vector<float>& per_area) {
    double sum = 0;
    for (const ElementIndex e : s.forest->leaves()) sum += static_cast<double>(per_area[e]) * s.forest->area(e);
    return sum;
}

/// Returns sum v P, the measurement of the view by light.
double measured_by_light(const Scene& scene, const Solution& s) {
    const std::vector<Rgb> b = radiosity(Materials(scene), *s.forest, s.irradiance);
    double sum = 0;
    for (const ElementIndex e : s.forest->leaves())
        sum += static_cast<double>(s.view_importance[e]) * s.forest->area(e) * b[e].x;
    return sum;
}

/// Returns sum psi W, the same measurement by the importance of the emitters.
double measured_by_importance(const Scene& scene, const Solution& s) {
    double sum = 0;
    for (const ElementIndex e : s.forest->leaves())
        sum += static_cast<double>(s.view_importance[e] + s.indirect_importance[e]) * s.forest->area(e) *
               Materials(scene).exitance(s.forest->patch(e)).x;
    return sum;
}

TEST(Importance, OfTheViewSumsToOne) {
    const Scene scene = grey_box();
    const Solution s = solve(scene, RayCaster(scene), options_for("ihsrr", 1));
    EXPECT_NEAR(sum_over_leaves(s, s.view_importance), 1, 1e-4);
    for (PatchIndex patch(45); patch < 54; ++patch) EXPECT_EQ(s.view_importance[patch], 0) << "the ceiling is not seen";
}

TEST(Importance, InAClosedGreyBoxIsViewImportanceOverOneMinusRho) {
    // Payloads are equal in a closed box, so there is no statistical error. The end of the start and the last merge
    // cause the deviation.
    for (const float rho : {0.0f, 0.5f, 0.8f}) {
        const Scene scene = closed_box({1, 2, 3}, 3, {{"grey", Rgb(rho), Rgb(1)}});
        SolveOptions options = options_for("isrr", 1);
        options.experimental.separate_iterations = true;  // gives all rays of an importance step the same payload
        const Solution s = solve(scene, RayCaster(scene), options);
        const double indirect = rho / (1 - rho);
        EXPECT_NEAR(sum_over_leaves(s, s.indirect_importance), indirect, 0.02 * indirect) << "rho " << rho;
    }
}

class Duality : public testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(All, Duality, testing::ValuesIn(variants_with_importance()),
                         [](const auto& test) { return test.param.name; });

// On a fixed mesh, where elements hold light and importance alike. The transports are adjoint only in the limit if the
// oracle deposits light and importance at different levels, or if V moves between elements as they are divided.
TEST_P(Duality, LightAndImportanceMeasureTheSame) {
    constexpr int runs = 16;
    const Scene scene = grey_box();
    const RayCaster ray_caster(scene);
    std::vector<double> differences;
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        SolveOptions options = on_a_fixed_mesh(GetParam(), seed);
        options.experimental.rays_per_iteration = 12'000;
        options.experimental.alpha = 0.5;
        if (options.experimental.importance_at_patches) options.refinement.min_area = left_whole;
        const Solution s = solve(scene, ray_caster, options);
        ASSERT_EQ(s.non_finite, 0);
        const double light = measured_by_light(scene, s);
        differences.push_back(light - measured_by_importance(scene, s));
        mean += light / runs;
    }
    EXPECT_GT(t_test(differences, 0), false_alarm);
    EXPECT_LT(t_test(differences, 0.05 * mean), false_alarm) << "would notice five percent";
}

}  // namespace
}  // namespace interflect
