#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "tests/exports/lightmap/lightmaps.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace lightmap_testing;
using testing_support::add_rectangle;

/// Sets the coordinates of the rectangle's vertices to the corners of a part of the unit square.
void lay_out(Scene& scene, PatchIndex patch, V2f corner, V2f across, V2f up) {
    scene.lightmap_coordinates.resize(scene.vertices.size(), V2f(std::nanf("")));
    const std::array<V2f, 4> at{corner, corner + across, corner + across + up, corner + up};
    for (std::size_t c = 0; c < at.size(); ++c) scene.lightmap_coordinates[scene.patches[patch].vertices[c]] = at[c];
}

/// A floor of 4 x 2 m and walls of 4 x 3 m and 2 x 3 m, of one object; the last is mirrored in its layout. Beside them
/// is a wall of another object without a layout.
Scene corner_with_layout() {
    Scene scene;
    const std::uint32_t material = testing_support::add_material(scene, Rgb(0.5f), Rgb(0));
    scene.objects = {"", "room", "screen"};
    const PatchIndex floor = add_rectangle(scene, V3f(0), V3f(4, 0, 0), V3f(0, 2, 0), material);
    const PatchIndex wall = add_rectangle(scene, V3f(0), V3f(0, 0, 3), V3f(4, 0, 0), material);
    const PatchIndex side = add_rectangle(scene, V3f(0), V3f(0, 2, 0), V3f(0, 0, 3), material);
    for (Patch& patch : scene.patches) patch.object = 1;
    const PatchIndex screen = add_rectangle(scene, V3f(1, 1, 0), V3f(1, 0, 0), V3f(0, 0, 1), material);
    scene.patches[screen].object = 2;
    lay_out(scene, PatchIndex(floor), {0.1f, 0.1f}, {0.4f, 0}, {0, 0.2f});
    lay_out(scene, PatchIndex(wall), {0.1f, 0.4f}, {0, 0.3f}, {0.4f, 0});
    lay_out(scene, PatchIndex(side), {0.9f, 0.4f}, {-0.2f, 0}, {0, 0.3f});
    scene.lightmap_coordinates.resize(scene.vertices.size(), V2f(std::nanf("")));
    return scene;
}

Solution of_each_patch(const Scene& scene) {
    Solution solution = uniform(scene, 0);
    for (std::size_t p = 0; p < solution.irradiance.size(); ++p)
        solution.irradiance[p] = Rgb(100.0f * static_cast<float>(1 + p));
    return solution;
}

// Image coordinates, in texels, are an affine function of the file's: three corners define the map, and all
// others agree with it. Fails without flipping the file's v, and with a chart for each face.
TEST(LightmapLayout, IsMovedAndScaledAsAWhole) {
    const Scene scene = corner_with_layout();
    ASSERT_TRUE(scene_faults(scene).empty());
    const Lightmap lightmap = make_lightmap(scene, of_each_patch(scene), at(20));
    ASSERT_EQ(lightmap.charts.size(), 2);
    const Image& image = lightmap.images[0];
    const std::array<Parameters, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const auto texel = [&](PatchIndex p, std::size_t c) {
        return lightmap.coordinate(p, corners[c]) *
               V2f(static_cast<float>(image.width), static_cast<float>(image.height));
    };
    const auto given = [&](PatchIndex p, std::size_t c) {
        return scene.lightmap_coordinates[scene.patches[p].vertices[c]];
    };
    const V2f along_u = (texel(PatchIndex(0), 1) - texel(PatchIndex(0), 0)) / 0.4f,
              along_v = (texel(PatchIndex(0), 3) - texel(PatchIndex(0), 0)) / 0.2f;
    EXPECT_LT(along_u.cross(along_v), 0);  // the image's rows run downwards: not mirrored
    EXPECT_NEAR(along_u.length() / along_v.length(), 1, 0.01);
    for (PatchIndex p{0}; p < 3; ++p)
        for (std::size_t c = 0; c < 4; ++c) {
            const V2f offset = given(p, c) - given(PatchIndex(0), 0);
            const V2f expected = texel(PatchIndex(0), 0) + along_u * offset.x + along_v * offset.y;
            EXPECT_LT((texel(p, c) - expected).length(), 1e-2) << p << " " << c;
        }
    EXPECT_NEAR((texel(PatchIndex(0), 1) - texel(PatchIndex(0), 0)).length(), 4 * 20, 1);  // 20 texels a metre
}

// Fails if places are found on the wrong patch, for example with a layout upside down.
TEST(LightmapLayout, HasTheLightOfEachFace) {
    const Scene scene = corner_with_layout();
    const Lightmap lightmap = make_lightmap(scene, of_each_patch(scene), at(20));
    const ElementForest forest(scene, scene.patches.size());
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        for (std::uint64_t i = 0; i < 500; ++i) {
            const float expected = 100.0f * static_cast<float>(1 + p);
            ASSERT_NEAR(sample(lightmap, p, random_place(forest.geometry(p), i)).x / expected, 1, 1e-4) << p;
        }
}

TEST(LightmapLayout, IsIgnoredOnDemand) {
    const Scene scene = corner_with_layout();
    ExportOptions options = at(20);
    options.lightmap->own_charts = true;
    EXPECT_EQ(make_lightmap(scene, of_each_patch(scene), options).charts.size(), 4);
}

struct UnusableLayout {
    const char* name;
    std::function<void(Scene&)> change;
    const char* fault;
};
void PrintTo(const UnusableLayout& layout, std::ostream* out) { *out << layout.name; }

class UnusableLightmapLayout : public testing::TestWithParam<UnusableLayout> {};

TEST_P(UnusableLightmapLayout, IsReplacedWithAWarning) {
    Scene scene = corner_with_layout();
    GetParam().change(scene);
    Warnings warnings;
    ExportOptions options = at(20);
    options.warnings = &warnings;
    const Lightmap lightmap = make_lightmap(scene, of_each_patch(scene), options);
    EXPECT_EQ(lightmap.charts.size(), 4);
    ASSERT_EQ(warnings.entries().size(), 1);
    EXPECT_EQ(warnings.entries()[0].where, "room");
    EXPECT_NE(warnings.entries()[0].message.find(GetParam().fault), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Faults, UnusableLightmapLayout,
    testing::Values(UnusableLayout{"Overlap",
                                   [](Scene& s) {
                                       lay_out(s, PatchIndex(1), {0.1f, 0.29f}, {0, 0.3f}, {0.4f, 0});
                                   },
                                   "overlaps itself"},
                    UnusableLayout{"Same",
                                   [](Scene& s) {
                                       lay_out(s, PatchIndex(2), {0.1f, 0.1f}, {0.4f, 0}, {0, 0.2f});
                                   },
                                   "overlaps itself"},
                    UnusableLayout{"NoArea",
                                   [](Scene& s) {
                                       lay_out(s, PatchIndex(2), {0.9f, 0.4f}, {0, 0}, {0, 0.3f});
                                   },
                                   "gives a face no area"},
                    UnusableLayout{"Empty",
                                   [](Scene& s) {
                                       for (V2f& at : s.lightmap_coordinates) at *= 0.2f;
                                       lay_out(s, PatchIndex(2), {1, 0.95f}, {-0.05f, 0}, {0, 0.05f});
                                   },
                                   "is mostly empty"}),
    testing::PrintToStringParamName());

// The front keeps its place; the back with the same coordinates receives a chart. Fails if both keep the layout.
TEST(LightmapLayout, IsThatOfTheFrontWhereBothSidesAreLit) {
    Scene scene;
    const PatchIndex screen = add_rectangle(scene, V3f(0), V3f(2, 0, 0), V3f(0, 1, 0),
                                            testing_support::add_material(scene, Rgb(0.5f), Rgb(0)), 1, 1, true);
    scene.objects = {"screen"};
    lay_out(scene, PatchIndex(screen), {0.2f, 0.1f}, {0.6f, 0}, {0, 0.3f});
    Warnings warnings;
    ExportOptions options = at(20);
    options.warnings = &warnings;
    const Solution solution = of_each_patch(scene);
    const Lightmap lightmap = make_lightmap(scene, solution, options);
    EXPECT_TRUE(warnings.entries().empty());
    EXPECT_EQ(lightmap.charts.size(), 2);
    for (PatchIndex p{0}; p < 2; ++p)
        for (std::uint64_t i = 0; i < 100; ++i) {
            const Parameters place = random_place(solution.forest->geometry(p), i);
            ASSERT_NEAR(sample(lightmap, p, place).x, 100.0f * static_cast<float>(1 + p), 0.1f) << p;
        }
}

TEST(LightmapLayout, MayTouchItself) {
    Scene scene = corner_with_layout();
    lay_out(scene, PatchIndex(1), {0.1f, 0.3f}, {0, 0.3f}, {0.4f, 0});
    Warnings warnings;
    ExportOptions options = at(20);
    options.warnings = &warnings;
    EXPECT_EQ(make_lightmap(scene, of_each_patch(scene), options).charts.size(), 2);
    EXPECT_TRUE(warnings.entries().empty());
}

}  // namespace
}  // namespace interflect
