// Textures in the solver: scenes with an exact answer, and scenes that can be modelled without a texture.
//
// Seen to fail if elements have the means of their patch, if exitance ignores its texture, or if the means of new
// elements are not computed.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/summary.h"
#include "tests/support/parameter_names.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/textured_scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

Solution solved(const Scene& scene, const std::string& method, std::int64_t rays = 600'000, std::uint64_t seed = 1) {
    SolveOptions options{.method = find_method(method)};
    options.limits.rays = rays;
    options.seed = seed;
    return solve(scene, RayCaster(scene), options);
}

class TexturesOfMethod : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, TexturesOfMethod,
                         testing::Values("srr", "hsrr", "wdrs", "hwdrs", "ihwdrs", "random-walk", "photon-mesh"),
                         [](const auto& method) {
                             std::string name = method.param;
                             std::erase(name, '-');
                             return name;
                         });

/// H is 2 1 3 everywhere. A deviation of 2% would be noticed.
TEST_P(TexturesOfMethod, FurnaceHasTheIrradianceOfItsRadiosity) {
    RELEASE_ONLY();  // see TexturesOfMethod.OfOneValueAreAsTheMaterial
    constexpr int runs = 12;
    const Rgb expected(2, 1, 3);
    const Scene scene = textured_furnace(expected);
    std::vector<std::vector<double>> samples(3 * scene.patches.size());
    std::vector<double> means;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution s = solved(scene, GetParam(), 100'000, seed);
        double mean = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const int c = static_cast<int>(i % 3);
            samples[i].push_back(static_cast<double>(s.irradiance[i / 3][c] / expected[c]));
            mean += samples[i].back() / static_cast<double>(samples.size());
        }
        means.push_back(mean);
    }
    std::vector<double> p;
    for (const auto& of_patch : samples) p.push_back(t_test(of_patch, 1));
    EXPECT_GT(bonferroni(p), false_alarm);
    EXPECT_GT(t_test(means, 1), false_alarm);
    EXPECT_LT(t_test(means, 1.02), false_alarm);
}

/// A texture of constant value is a factor of the material: the solution is the same to rounding.
TEST_P(TexturesOfMethod, OfOneValueAreAsTheMaterial) {
    Scene plain = closed_box({1, 2, 3}, 2, {{"wall", Rgb(0.25f), Rgb(2)}}), textured = plain;
    textured.materials[0] = {"wall", Rgb(0.5f), Rgb(4), 0, 0};
    textured.textures = {{"half", 3, 2, std::vector<Rgb>(6, Rgb(0.5f))}};
    textured.texture_coordinates.assign(textured.vertices.size(), V2f(0.3f, 0.3f));
    const Solution a = solved(plain, GetParam(), 50'000), b = solved(textured, GetParam(), 50'000);
    ASSERT_EQ(a.forest->size(), b.forest->size());
    for (ElementIndex e{0}; e < a.forest->size(); ++e)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(a.irradiance[e][c], b.irradiance[e][c], 1e-6f * a.irradiance[e][c]) << "element " << e;
}

/// Returns the mean irradiance of the ceiling, patches 24 to 31 of the half dark rooms. The floor lights it.
double ceiling_irradiance(const Solution& s) {
    double sum = 0, area = 0;
    for (std::uint32_t i = 24; i < 32; ++i) {
        sum += static_cast<double>(s.irradiance[i].y * s.forest->area(ElementIndex(i)));
        area += static_cast<double>(s.forest->area(ElementIndex(i)));
    }
    return sum / area;
}

class HalfDarkFloor : public testing::TestWithParam<std::tuple<std::string, Halves>> {
  protected:
    std::string method() const { return std::get<0>(GetParam()); }
    Halves halves() const { return std::get<1>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(MethodsThatRefine, HalfDarkFloor,
                         testing::Combine(testing::Values("hsrr", "hwdrs", "hr", "photon-mesh"),
                                          testing::Values(Halves::reflect, Halves::emit)),
                         printed_name);

/// The dark half of the floor is under no lamp, or is dark itself. If the mean covered both halves, or the lit half
/// were dark, the ceiling would receive different light.
TEST_P(HalfDarkFloor, IsAsTwoPatches) {
    RELEASE_ONLY();
    const Solution textured = solved(half_dark_floor(halves()), method());
    const Solution two = solved(half_dark_floor_of_two_patches(halves()), method());
    EXPECT_NEAR(ceiling_irradiance(textured) / ceiling_irradiance(two), 1, 0.015);
    const double power = luminance(textured.iterations.back().total_power);
    EXPECT_NEAR(power / luminance(two.iterations.back().total_power), 1, 0.015);
}

TEST(Textures, MeanReflectanceWouldBeNoticed) {
    RELEASE_ONLY();
    Scene mean = half_dark_floor(Halves::reflect);
    mean.textures[0].texels.assign(mean.textures[0].texels.size(), Rgb(0.5f));
    const Solution grey = solved(mean, "hsrr"), two = solved(half_dark_floor_of_two_patches(Halves::reflect), "hsrr");
    EXPECT_LT(ceiling_irradiance(grey) / ceiling_irradiance(two), 0.95);
}

TEST(Textures, EmittedPowerIsTheIntegral) {
    const Solution s = solved(half_dark_floor(Halves::emit), "hsrr", 100'000);
    EXPECT_NEAR(s.emitted_power.x, 4.0 * 2 * 100 / 2, 1e-3);  // half of 4 x 2 m, 100 lm/m^2
}

/// The elements of a patch, at any depth, emit the same total power as the patch.
TEST(Textures, ElementsEmitWhatTheirPatchesDo) {
    const Scene scene = textured_furnace(Rgb(2, 1, 3));
    Materials materials(scene);
    ElementForest forest(scene, 100'000);
    const std::vector<Rgb> darkness(100'000, Rgb(0));
    const RgbD expected = radiated_power(forest, Radiosity(materials, darkness));
    for (ElementIndex e{0}; e < 5'000; ++e) forest.subdivide(e);
    materials.grow(forest);
    const RgbD actual = radiated_power(forest, Radiosity(materials, darkness));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c] / expected[c], 1, 1e-5);
}

/// Means depend on the patch and the cell, not on the order in which the elements were made.
TEST(Textures, MeansDoNotDependOnTheOrderOfElements) {
    const Scene scene = textured_furnace(Rgb(2, 1, 3));
    Materials at_once(scene), step_by_step(scene);
    ElementForest forest(scene, 10'000);
    for (ElementIndex e{0}; e < 500; ++e) {
        forest.subdivide(e);
        step_by_step.grow(forest);
    }
    at_once.grow(forest);
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        const MeanSurface a = at_once.surface(forest.patch(e), e), b = step_by_step.surface(forest.patch(e), e);
        EXPECT_EQ(a.reflectance, b.reflectance);
        EXPECT_EQ(a.exitance, b.exitance);
    }
}

/// A partly covered patch emits from its uncovered area, with or without a texture.
TEST(Textures, OfCoveredEmittersAreReduced) {
    Scene scene = half_dark_floor(Halves::emit);
    const auto floor = static_cast<std::uint32_t>(scene.patches.size() - 1);
    add_rectangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 1, 0}, 0);  // half of it; the smaller face covers
    scene.texture_coordinates.resize(scene.vertices.size(), V2f(0));
    const RayCaster ray_caster(scene);
    EXPECT_NEAR(Materials(scene, ray_caster).exitance(PatchIndex(floor)).x, 25, 1e-3);
    EXPECT_NEAR(covered_emission(scene, ray_caster).power.x, 4.0 * 2 * 25, 1e-2);
}

}  // namespace
}  // namespace interflect
