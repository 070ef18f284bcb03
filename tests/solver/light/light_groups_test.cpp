// Light groups: the light of each, computed with the same rays, and the effect of dimming.
//
// Seen to fail if the share of a group lacks reflected light, if a patch emits for every group, if passes omit unshot
// light of groups, if the differences of siblings of all groups are not scaled by the same factor, or if set_dimming()
// does not change the emission.

#include "interflect/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solution.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "interflect/solver/light/materials.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

const View into_the_room = {"room", {0.3, 0.4, 1.9}, {3.5, 2.3, 0.4}, {0, 0, 1}, 65};

/// Returns a room of 4.3 x 2.7 x 2.4 m with a red lamp, a blue lamp, a point light, and a sky behind the missing
/// quarter of the ceiling.
Scene lit_room() {
    Scene scene = closed_box({4.3f, 2.7f, 2.4f}, 2, {{"wall", {0.7f, 0.6f, 0.5f}, Rgb(0)}});
    scene.patches.pop_back();
    scene.objects = {"", "lamps.red", "lamps.blue", "torch"};
    const auto add_lamp = [&](V3f corner, Rgb exitance, std::uint32_t object) {
        const PatchIndex first = add_rectangle(scene, corner, {0, 0.4f, 0}, {0.3f, 0, 0},
                                               add_material(scene, Rgb(0.2f), exitance), 1, 1, true);
        for (std::uint32_t i = first; i < scene.patches.size(); ++i) scene.patches[i].object = object;
    };
    add_lamp({0.9f, 1.1f, 2.2f}, {90, 20, 10}, 1);
    add_lamp({3.1f, 0.6f, 1.4f}, {5, 20, 120}, 2);
    scene.luminaires = {{"torch", 3, PointLight{{3.2f, 2.0f, 0.7f}, {3, 3, 2}}}, {"sky", 0, UniformSky{{4, 5, 7}}}};
    scene.light_groups = {{"red", "lamps.red"}, {"blue", "*blue"}, {"torch", "torch"}};
    return scene;
}

SolveOptions grouped_options(const std::string& method, std::int64_t rays = 400'000) {
    SolveOptions options{.method = find_method(method)};
    options.limits.rays = rays;
    options.importance.camera_rays = 1 << 13;
    if (options.method.importance != ImportanceUse::off) options.views = {{into_the_room}};
    return options;
}

/// Returns the root mean square difference over the root mean square of b, of patches weighted by area.
double difference(const ElementForest& forest, const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    double error = 0, square = 0;
    for (PatchIndex i{0}; i < forest.patch_count(); ++i) {
        error += forest.area(i) * (a[i] - b[i]).length2();
        square += forest.area(i) * b[i].length2();
    }
    return std::sqrt(error / square);
}

TEST(LightGroups, FindTheirSources) {
    const SourceGroups groups = source_groups(lit_room());
    EXPECT_EQ(groups.names, (std::vector<std::string>{"red", "blue", "torch", "other"}));
    EXPECT_EQ(groups.of_luminaire, (std::vector<std::uint8_t>{2, 3}));
    Scene scene = lit_room();
    scene.light_groups = {{"all lamps", "lamps"}};
    EXPECT_EQ(source_groups(scene).of_patch.back(), 0);
    scene.light_groups = {{"none", "lam?"}};
    EXPECT_THROW(require_sources_of_groups(scene), InputError);
    scene.light_groups = {{"twice", "*"}, {"twice", "*"}};
    EXPECT_THROW(source_groups(scene), InputError);
}

TEST(LightGroups, AreNamedByObjects) {
    const std::vector<LightGroup> groups = groups_by_name(lit_room());
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(groups[0].name, "lamps");
    EXPECT_EQ(groups[1].name, "torch");
}

TEST(LightGroups, PatternsMatch) {
    EXPECT_TRUE(matches("a*b?d", "aXXbcbcd"));
    EXPECT_TRUE(matches("*", ""));
    EXPECT_TRUE(matches("lamp", "lamp"));
    EXPECT_FALSE(matches("lamp", "lamps"));
    EXPECT_FALSE(matches("?", ""));
    EXPECT_FALSE(matches("a*a", "a"));
}

class LightGroupsOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, LightGroupsOf, testing::Values("srr", "hsrr", "ihsrr", "wdrs", "hwdrs"),
                         printed_name);

TEST_P(LightGroupsOf, SumToTheUngroupedSolution) {
    const Scene grouped = lit_room();
    Scene together = grouped;
    together.light_groups.clear();
    const RayCaster ray_caster(grouped);
    const Solution solution = solve(grouped, ray_caster, grouped_options(GetParam()));
    const Solution expected = solve(together, ray_caster, grouped_options(GetParam()));
    ASSERT_EQ(solution.forest->subdivided(), expected.forest->subdivided());
    EXPECT_EQ(solution.irradiance, expected.irradiance);
    ASSERT_EQ(solution.groups.size(), 4u);
    for (std::size_t e = 0; e < solution.irradiance.size(); ++e)
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (const std::vector<Rgb>& of_group : solution.groups) {
                ASSERT_GE(of_group[e][c], 0);
                sum += static_cast<double>(of_group[e][c]);
            }
            ASSERT_NEAR(sum, solution.irradiance[e][c], 2e-6 * solution.irradiance[e][c] + 1e-30);
        }
}

/// Compares with each group solved alone, with its own rays and the same method, because coarse meshes move light.
TEST_P(LightGroupsOf, AreWhatEachBringsAlone) {
    const Scene scene = lit_room();
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, grouped_options(GetParam(), 2'000'000));
    const SourceGroups groups = source_groups(scene);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::vector<float> only(groups.size(), 0);
        only[g] = 1;
        Scene alone = dimmed(scene, groups, only);
        alone.light_groups.clear();
        const Solution expected = solve(alone, ray_caster, grouped_options(GetParam(), 2'000'000));
        EXPECT_LT(difference(*solution.forest, solution.groups[g], expected.irradiance), 0.05) << groups.names[g];
    }
}

TEST(Dimming, IsWhatSolvingTheDimmedSceneGives) {
    Scene scene = lit_room();
    const RayCaster ray_caster(scene);
    Solution solution = solve(scene, ray_caster, grouped_options("hsrr", 2'000'000));
    dim(scene, solution, "other", 0);
    dim(scene, solution, "blue", 0);  // dark groups remain groups
    dim(scene, solution, "red", 0.25f);
    dim(scene, solution, "torch", 3);
    Scene together = scene;
    together.light_groups.clear();
    const Solution expected = solve(together, ray_caster, grouped_options("hsrr", 2'000'000));
    EXPECT_LT(difference(*solution.forest, solution.irradiance, expected.irradiance), 0.02);
    EXPECT_THROW(dim(scene, solution, "green", 1), InputError);
    EXPECT_THROW(dim(scene, solution, "red", -1), InputError);
    EXPECT_THROW(dim(together, solution, "red", 1), InputError);
}

/// Each element keeps the ratio of its unreduced irradiance to the reduced one.
TEST(Dimming, ScalesTheUnreducedIrradiance) {
    Scene scene = lit_room();
    Solution solution = solve(scene, RayCaster(scene), grouped_options("hsrr"));
    const std::vector<Rgb> before = solution.irradiance, unreduced = solution.unreduced_irradiance;
    ASSERT_EQ(unreduced.size(), before.size());
    dim(scene, solution, "red", 0.25f);
    for (std::size_t e = 0; e < before.size(); ++e)
        for (int c = 0; c < 3; ++c) {
            const float expected = before[e][c] > 0 ? unreduced[e][c] * (solution.irradiance[e][c] / before[e][c]) : 0;
            ASSERT_NEAR(solution.unreduced_irradiance[e][c], expected, 1e-5f * expected + 1e-12f);
        }
}

class ExitanceOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, ExitanceOf, testing::Values("hsrr", "ihsrr"), printed_name);

/// Dims groups in the middle of a run, one to 0 and back. The result must be the solution of the dimmed scene.
TEST_P(ExitanceOf, ChangesInTheMiddleOfARun) {
    SolveOptions options = grouped_options(GetParam(), 4'000'000);
    Solver solver(lit_room(), options);
    solver.advance({.rays = 500'000});
    solver.set_dimming("blue", 0);
    solver.set_dimming("red", 0.5f);
    const RgbD dark = integral(*solver.solution().forest, solver.solution().groups[1]);
    EXPECT_EQ(dark, RgbD(0));
    solver.advance({.rays = 800'000});
    solver.set_dimming("blue", 2);
    solver.advance({});
    const Scene& scene = solver.scene();
    Scene together = scene;
    together.light_groups.clear();
    const Solution expected = solve(together, solver.ray_caster(), grouped_options(GetParam(), 4'000'000));
    EXPECT_LT(difference(*solver.solution().forest, solver.solution().irradiance, expected.irradiance), 0.025);
    EXPECT_NEAR(solver.solution().emitted_power.x / expected.emitted_power.x, 1, 1e-6);
    EXPECT_THROW(solver.set_dimming("green", 1), InputError);
    EXPECT_THROW(solver.set_dimming("red", NAN), InputError);
}

TEST(LightGroups, AreRefusedByMethodsThatKeepLightTogether) {
    for (const char* method : {"random-walk", "hr"})
        EXPECT_THROW(Solver(lit_room(), grouped_options(method)), InputError);
}

}  // namespace
}  // namespace interflect
