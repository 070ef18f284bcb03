#include "interflect/exports/mesh/shown_patches.h"

#include <gtest/gtest.h>

#include <utility>

#include "interflect/geometry/polygons/polygon.h"

namespace interflect {

using namespace detail;
namespace {

/// A two-sided square and a one-sided one above it; patches 0 and 1 are the sides of the first.
Scene two_squares(float exitance = 0, float height = 1) {
    Scene scene;
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (std::size_t i = 0; i < 4; ++i) scene.vertices.push_back(scene.vertices[i] + V3f(0, 0, height));
    scene.objects = {""};
    scene.materials = {{.name = "grey", .reflectance = Rgb(0.5f), .exitance = Rgb(exitance)}};
    const std::vector<std::uint32_t> lower{0, 1, 2, 3}, upper{4, 5, 6, 7};
    add_polygon(scene, {&lower, 1}, 0, 0, true);
    add_polygon(scene, {&upper, 1}, 0, 0, false);
    return scene;
}

Solution with_light(std::vector<Rgb> irradiance) {
    Solution solution;
    solution.irradiance = std::move(irradiance);
    return solution;
}

struct Sides {
    const char* name;
    float front, back;  // irradiance
    std::vector<bool> shown;
};
void PrintTo(const Sides& sides, std::ostream* out) { *out << sides.name; }

class ShownPatches : public testing::TestWithParam<Sides> {};

TEST_P(ShownPatches, AreThoseThatLightComesFrom) {
    const auto& [name, front, back, shown] = GetParam();
    EXPECT_EQ(shown_patches(two_squares(), with_light({Rgb(front), Rgb(back), Rgb(0)})), shown);
}

INSTANTIATE_TEST_SUITE_P(Of, ShownPatches,
                         testing::Values(Sides{"BothLit", 1, 2, {true, true, true}},
                                         Sides{"DarkBack", 1, 0, {true, false, true}},
                                         Sides{"DarkFront", 0, 2, {false, true, true}},
                                         Sides{"BothDark", 0, 0, {true, false, true}},
                                         // 0.001 lx is the limit where the rest is bright, else 1e-4 of the mean
                                         Sides{"DimBack", 100, 0.9e-3f, {true, false, true}},
                                         Sides{"DimBackAboveTheLimit", 100, 1.1e-3f, {true, true, true}},
                                         Sides{"DimBackOfADimFront", 1, 3e-5f, {true, false, true}},
                                         Sides{"DimBackOfADimFrontAboveTheLimit", 1, 4e-5f, {true, true, true}}),
                         testing::PrintToStringParamName());

TEST(ShownPatchesOfALamp, AreBothThoughNothingLightsThem) {
    EXPECT_EQ(shown_patches(two_squares(100), with_light(std::vector<Rgb>(3, Rgb(0)))), std::vector<bool>(3, true));
}

TEST(ShownPatchesOfADimmedSolution, AreThoseOfTheUndimmedOne) {
    const Scene scene = two_squares();
    Solution solution = with_light({Rgb(1), Rgb(0), Rgb(0)});
    solution.undimmed_light = {1, 1, 0};
    EXPECT_EQ(shown_patches(scene, solution), std::vector<bool>(3, true));
}

TEST(ShownPatchesOfCoincidentFaces, AreThoseThatAnswerRays) {
    const Scene scene = two_squares(0, 0);
    EXPECT_EQ(shown_patches(scene, with_light(std::vector<Rgb>(3, Rgb(1)))), (std::vector<bool>{true, true, false}));
}

/// A two-sided floor in two parts (patches 0 to 3). A two-sided box stands on the second part: 4 and 5 are its lid, the
/// rest are its sides. The last side ends `gap` above the floor [m].
Scene floor_with_box(float height, float gap) {
    Scene scene;
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    for (const std::size_t i : {1u, 4u, 5u, 2u}) scene.vertices.push_back(scene.vertices[i] + V3f(0, 0, height));
    for (const std::size_t i : {1u, 2u}) scene.vertices.push_back(scene.vertices[i] + V3f(0, 0, gap));
    scene.objects = {""};
    scene.materials = {{.name = "grey", .reflectance = Rgb(0.5f)}};
    const std::vector<std::vector<std::uint32_t>> faces{{0, 1, 2, 3}, {1, 4, 5, 2}, {6, 7, 8, 9},
                                                        {1, 4, 7, 6}, {4, 5, 8, 7}, {5, 2, 9, 8}};
    for (const auto& face : faces) add_polygon(scene, {&face, 1}, 0, 0, true);
    const std::vector<std::uint32_t> last{11, 10, 6, 9};
    add_polygon(scene, {&last, 1}, 0, 0, true);
    return scene;
}

/// Returns an irradiance of 1 on the patches whose light can reach them, 0 on those in the box.
Solution light_above(const Scene& scene) {
    std::vector<Rgb> irradiance(scene.patches.size(), Rgb(0));
    irradiance[0] = Rgb(1);
    for (std::size_t p = 4; p < irradiance.size(); p += 2) irradiance[p] = Rgb(1);
    return with_light(irradiance);
}

TEST(ShownPatchesInABox, AreLeftOutWhereNothingButDarknessIsSeen) {
    const Scene scene = floor_with_box(0.01f, 0);
    const std::vector<bool> shown = shown_patches(scene, light_above(scene));
    EXPECT_TRUE(shown[0]);
    EXPECT_FALSE(shown[2]);  // dark on both sides; it was shown, and drawn along the edges of the box
    for (std::size_t p = 4; p < shown.size(); ++p) EXPECT_EQ(shown[p], p % 2 == 0) << p;
}

TEST(ShownPatchesInABox, AreLeftOutDespiteLightThatLeaksIn) {
    const Scene scene = floor_with_box(0.01f, 0);
    Solution solution = light_above(scene);
    for (Rgb& h : solution.irradiance) h = h * 100.0f + Rgb(1e-2f);
    const std::vector<bool> shown = shown_patches(scene, solution);
    EXPECT_FALSE(shown[2]);
    for (std::size_t p = 4; p < shown.size(); ++p) EXPECT_EQ(shown[p], p % 2 == 0) << p;
}

TEST(ShownPatchesInABox, StayWhereAGapLetsThemSeeLight) {
    const Scene scene = floor_with_box(0.5f, 0.4f);
    EXPECT_TRUE(shown_patches(scene, light_above(scene))[2]);
}

}  // namespace
}  // namespace interflect
