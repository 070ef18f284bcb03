// Areas, reflectances and power of small scenes against sums by hand.
#include "interflect/summary.h"

#include <gtest/gtest.h>

#include <numbers>

#include "interflect/core.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

SceneSummary summary_of(const Scene& scene) { return summarise(scene, RayCaster(scene)); }

/// A room of 2 x 3 x 4 m whose floor emits, with a two-sided emitting square in it.
Scene lit_room() {
    const Material paint{.name = "paint", .reflectance = Rgb(0.5f)}, lamp{.name = "lamp", .exitance = Rgb(1, 2, 3)};
    Scene scene = closed_box({2, 3, 4}, 2, {paint, paint, paint, paint, lamp, paint});
    const std::uint32_t sign = add_material(scene, Rgb(0.2f), Rgb(10));
    scene.objects.emplace_back("sign");
    const PatchIndex first = add_rectangle(scene, {0.5f, 1, 1}, {1, 0, 0}, {0, 1, 0}, sign, 1, 1, true);
    scene.patches[first].object = scene.patches[first + 1].object =
        static_cast<std::uint32_t>(scene.objects.size() - 1);
    return scene;
}

TEST(SceneSummary, CountsPatchesAndAreas) {
    Scene scene = lit_room();
    scene.origin = {10, 0, 0};
    const SceneSummary summary = summary_of(scene);
    EXPECT_EQ(summary.triangles, 0u);
    EXPECT_EQ(summary.two_sided, 2u);
    EXPECT_EQ(summary.bounds.min, Imath::V3d(10, 0, 0));
    EXPECT_EQ(summary.bounds.max, Imath::V3d(12, 3, 4));
    EXPECT_NEAR(summary.area, 52 + 1, 1e-4) << "the square counts once";
}

TEST(SceneSummary, AddsUpThePowerOfMaterials) {
    const Scene scene = lit_room();
    double area = 0;
    RgbD power(0);
    for (const MaterialSummary& m : summary_of(scene).materials) {
        area += m.area;
        power += m.power;
        const std::string& name = scene.materials[m.material].name;
        if (name == "paint") {
            EXPECT_NEAR(m.reflectance.y, 0.5, 1e-6);
        }
        if (name == "lamp") {
            EXPECT_EQ(m.emitting_patches, 4u);
            EXPECT_EQ(m.emitting_objects, 1u);
            EXPECT_NEAR(m.emitting_area, 6, 1e-5);
            EXPECT_NEAR(m.power.z, 6 * 3, 1e-4);
        }
    }
    EXPECT_NEAR(area, 53, 1e-4);
    EXPECT_NEAR(power.x, 6 * 1 + 2 * 10, 1e-4) << "both sides of the square emit";
    EXPECT_EQ(summary_of(scene).emitted_power, power);
}

/// A point light of intensity I emits 4 pi I.
TEST(SceneSummary, IncludesLuminaires) {
    Scene scene = closed_box({2, 2, 2}, 1, {{.name = "black"}});
    scene.luminaires.push_back({"bulb", 0, PointLight{{1, 1, 1}, {1, 2, 3}}});
    const SceneSummary summary = summary_of(scene);
    ASSERT_EQ(summary.luminaires.size(), 1u);
    EXPECT_NEAR(summary.luminaires[0].z, 12 * std::numbers::pi, 1e-3);
    EXPECT_NEAR(summary.emitted_power.x, 4 * std::numbers::pi, 1e-3);
}

TEST(SceneSummary, OfAnotherSceneIsRefused) {
    const Scene scene = lit_room(), other = closed_box({1, 1, 1}, 1, {{.name = "black"}});
    EXPECT_THROW(summarise(scene, RayCaster(other)), InputError);
}

}  // namespace
}  // namespace interflect
