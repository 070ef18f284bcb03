// Options at the ends of their ranges. dense_test.cpp tests that alpha, beta and other options do not change the mean,
// also at their ends. Seen to fail if descendants of new elements have the full history of these, or if alpha or beta
// is ignored.

#include <gtest/gtest.h>

#include <cmath>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

SolveOptions options_of(const char* method) {
    SolveOptions options{.method = find_method(method)};
    options.limits.rays = 80'000;
    options.views = {{into_the_corner}};
    return options;
}

/// Returns the solution after iteration `last`; 0 is the preparation of the run.
Solution solve_until(int last, const Scene& scene, const SolveOptions& options) {
    std::atomic<bool> stop{false};
    return solve(scene, RayCaster(scene), options,
                 {[&](const Progress& progress) { stop = progress.iteration->iteration == last; }, &stop});
}

Solution solve_all(const Scene& scene, const SolveOptions& options) { return solve(scene, RayCaster(scene), options); }

Scene furnace(int n) { return closed_box({1, 2, 3}, n, {{"wall", Rgb(0.5f), Rgb(2)}}); }

TEST(Importance, ChangesNothingWithoutAView) {
    const Scene scene = furnished_room();
    const auto solved = [&](const char* method) {
        SolveOptions options = options_of(method);
        options.views.clear();
        return solve_all(scene, options).irradiance;
    };
    EXPECT_EQ(solved("isrr"), solved("srr"));
    EXPECT_EQ(solved("ihsrr"), solved("hsrr"));
}

TEST(AlphaZeroAndBetaOne, ShootEveryRayByPowerAlone) {
    const Scene scene = colourful_box();
    SolveOptions by_importance = options_of("isrr"), by_power = options_of("srr");
    by_importance.experimental.one_bounce = by_power.experimental.one_bounce = true;
    by_importance.experimental.alpha = 0;
    by_importance.experimental.beta = 1;
    const std::vector<Rgb> driven = solve_all(scene, by_importance).irradiance;
    const std::vector<Rgb> plain = solve_all(scene, by_power).irradiance;
    // The weights are equal up to rounding, which may occasionally move a ray to the next patch.
    for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(driven[i].x / plain[i].x, 1, 1e-3) << i;
}

TEST(AlphaZero, LeavesImportanceAsThePreparationFoundIt) {
    const Scene scene = colourful_box();
    SolveOptions options = options_of("isrr");
    options.experimental.separate_iterations = true;
    options.experimental.alpha = 0;
    const Solution start = solve_until(0, scene, options), end = solve_all(scene, options);
    EXPECT_EQ(end.indirect_importance, start.indirect_importance);
    EXPECT_EQ(end.iterations.back().importance_rays, start.iterations.back().importance_rays);
    EXPECT_NE(end.irradiance, start.irradiance);
}

TEST(AlphaOne, LeavesLightAsThePreparationFoundIt) {
    const Scene scene = colourful_box();
    SolveOptions options = options_of("isrr");
    options.experimental.separate_iterations = true;
    options.experimental.alpha = 1;
    const Solution start = solve_until(0, scene, options), end = solve_all(scene, options);
    EXPECT_EQ(end.irradiance, start.irradiance);
    EXPECT_EQ(end.iterations.back().power_rays, start.iterations.back().power_rays);
    EXPECT_NE(end.indirect_importance, start.indirect_importance);
}

/// Traces two iterations of single bounces, with so few rays that each misses some leaves. The first divides all
/// elements.
Solution two_iterations_trusting(double inherited_weight) {
    SolveOptions options = options_of("hsrr");
    options.views.clear();
    options.experimental.rays_per_iteration = 1000;
    options.experimental.one_bounce = true;
    options.experimental.inherited_weight = inherited_weight;
    divide_everything(options, 0.03);  // m^2; the walls have 2, 3 and 6: three levels
    return solve_until(2, furnace(1), options);
}

// Seen to fail if merged siblings are not corrected: light lost with the history was missing, 0.2% here.
TEST(InheritedTrust, NeitherLosesNorMakesLight) {
    ASSERT_EQ(two_iterations_trusting(1).forest->size(), 6u * (1 + 4 + 16 + 64));
    const double all = two_iterations_trusting(1).iterations.back().total_power.x;
    for (const double trust : {0.0, 0.1, 0.5})
        EXPECT_NEAR(two_iterations_trusting(trust).iterations.back().total_power.x / all, 1, 1e-5) << trust;
}

TEST(OneIteration, FromDarknessIsOneBounce) {
    for (const char* method : {"srr", "hsrr"}) {
        SolveOptions options = options_of(method);
        options.experimental.one_bounce = true;
        options.experimental.iterations = 1;
        const Solution s = solve_all(furnace(1), options);
        ASSERT_EQ(s.iterations.size(), 1u);
        EXPECT_NEAR(s.iterations[0].total_power.x / s.emitted_power.x, 1.5, 1e-5) << "M + rho M";
    }
}

TEST(WarmUp, ThatNeverEndsKeepsOneMoreBounceEachTime) {
    SolveOptions options = options_of("hsrr");
    options.experimental.one_bounce = true;
    options.experimental.warm_up = 100;
    options.experimental.rays_per_iteration = 20'000;
    const Solution s = solve_all(furnace(1), options);
    ASSERT_EQ(s.iterations.size(), 4u);
    EXPECT_NEAR(s.iterations.back().total_power.x / s.emitted_power.x, 1 + 0.5 + 0.25 + 0.125 + 0.0625, 1e-5);
}

}  // namespace
}  // namespace interflect
