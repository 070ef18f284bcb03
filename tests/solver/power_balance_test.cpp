// What is emitted is absorbed or escapes, in closed and open scenes, with textures and glass.

#include "interflect/power_balance.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

PowerBalance balance_of(const Scene& scene, const char* method) {
    const RayCaster ray_caster(scene);
    return power_balance(scene,
                         solve(scene, ray_caster, {.method = find_method(method), .limits = {.rays = 1'000'000}}));
}

class Balance : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Method, Balance, testing::Values("srr", "hsrr"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_P(Balance, OfAClosedRoomIsExact) {
    const PowerBalance balance =
        balance_of(closed_box({2, 3, 2}, 2, {Material{"", {0.7f, 0.5f, 0.2f}, Rgb(10)}}), GetParam());
    EXPECT_NEAR(channel_sum(balance.emitted), 3 * 10 * 2 * (2 * 3 + 2 * 2 + 2 * 3), 1e-3);
    EXPECT_EQ(balance.escaped, RgbD(0));
    EXPECT_NEAR(balance.relative_difference(), 0, 1e-3);
}

/// A point light over a floor, half of it under a pane of glass. Seen to fail without the pane's transmittance (light
/// that goes through would count as absorbed there) and without what escapes.
TEST_P(Balance, OfAnOpenSceneWithGlassCloses) {
    Scene scene;
    add_rectangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 2, 2);
    const std::uint32_t glass = add_material(scene, Rgb(0.1f), Rgb(0));
    scene.materials[glass].transmittance = {0.8f, 0.7f, 0.3f};
    add_rectangle(scene, {0, 0, 1}, {2, 0, 0}, {0, 4, 0}, glass, 1, 1, true);
    scene.luminaires.push_back({"lamp", 0, PointLight{{2, 2, 2}, Rgb(100)}});
    const PowerBalance balance = balance_of(scene, GetParam());
    EXPECT_GT(channel_sum(balance.escaped), 0.5 * channel_sum(balance.emitted));
    EXPECT_GT(channel_sum(balance.absorbed), 0.1 * channel_sum(balance.emitted));
    EXPECT_NEAR(balance.relative_difference(), 0, 2e-3);
}

}  // namespace
}  // namespace interflect
