#include "interflect/exports/shown_patches.h"

#include <gtest/gtest.h>

#include "interflect/geometry/polygon.h"

namespace interflect {
namespace {

/// A two-sided square and a one-sided one; patches 0 and 1 are the sides of the first.
Scene two_squares(float exitance = 0) {
    Scene scene;
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.materials = {{.name = "grey", .reflectance = Rgb(0.5f), .exitance = Rgb(exitance)}};
    const std::vector<std::uint32_t> loop{0, 1, 2, 3};
    add_polygon(scene, {&loop, 1}, 0, 0, true);
    add_polygon(scene, {&loop, 1}, 0, 0, false);
    return scene;
}

struct Sides {
    const char* name;
    float front, back;  // irradiance
    std::vector<bool> shown;
};

class ShownPatches : public testing::TestWithParam<Sides> {};

TEST_P(ShownPatches, AreThoseThatLightComesFrom) {
    const auto& [name, front, back, shown] = GetParam();
    EXPECT_EQ(shown_patches(two_squares(), std::vector<Rgb>{Rgb(front), Rgb(back), Rgb(0)}), shown);
}

INSTANTIATE_TEST_SUITE_P(Of, ShownPatches,
                         testing::Values(Sides{"BothLit", 1, 2, {true, true, true}},
                                         Sides{"DarkBack", 1, 0, {true, false, true}},
                                         Sides{"DarkFront", 0, 2, {false, true, true}},
                                         Sides{"BothDark", 0, 0, {true, false, true}}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(ShownPatchesOfALamp, AreBothThoughNothingLightsThem) {
    EXPECT_EQ(shown_patches(two_squares(100), std::vector<Rgb>(3, Rgb(0))), std::vector<bool>(3, true));
}

}  // namespace
}  // namespace interflect
