// Emitted power is absorbed or escapes, in closed and open scenes, with textures and glass.

#include "interflect/solution.h"

#include <gtest/gtest.h>

#include <vector>

#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

PowerBalance balance_of(const Scene& scene, const char* method) {
    const std::int64_t rays = is_sanitized ? 100'000 : 1'000'000;
    const RayCaster ray_caster(scene);
    return power_balance(scene, solve(scene, ray_caster, {.method = find_method(method), .limits = {.rays = rays}}));
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

/// Returns a room lit by a panel, with a ninth of one wall missing.
Scene open_room() {
    Scene scene = closed_box({4, 3, 2.5f}, 3, {Material{"", Rgb(0.7f), Rgb(0)}});
    scene.patches.erase(scene.patches.begin() + 13);
    scene.patches[47].material = add_material(scene, Rgb(0.5f), Rgb(1000));
    return scene;
}

/// Escaped power is averaged over the passes, like irradiance. Random walks complete each pass, so the balance closes
/// in the mean over seeds; correct code fails with probability `false_alarm`. Seen to fail with the escaped power of
/// the last pass alone (0.6% either way).
TEST_P(Balance, OfAnOpenRoomCloses) {
    RELEASE_ONLY();  // see Balance.OfAnOpenSceneWithGlassCloses
    const Scene scene = open_room();
    const RayCaster ray_caster(scene);
    std::vector<double> differences;
    for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
        std::vector<double> escaped;
        const SolveOptions options{.method = find_method(GetParam()), .limits = {.rays = 60'000}, .seed = seed};
        const Solution solution =
            solve(scene, ray_caster, options,
                  {.on_progress = [&](const Progress& p) { escaped.push_back(p.iteration->escaped_power.x); }});
        const PowerBalance balance = power_balance(scene, solution);
        EXPECT_GT(balance.escaped.x, 0.03 * balance.emitted.x);
        EXPECT_NEAR(balance.relative_difference(), 0, 2e-3);
        for (const double e : escaped)
            EXPECT_NEAR(e, balance.escaped.x, 0.3 * balance.escaped.x) << "from the first on";
        differences.push_back(balance.relative_difference());
    }
    EXPECT_GT(t_test(differences, 0), false_alarm);
}

/// After dimming, power that escaped before does not count. Seen to fail by 2% otherwise.
TEST_P(Balance, ClosesAfterTheLampIsDimmed) {
    Scene scene = open_room();
    scene.light_groups = {{"lamp", scene.materials.back().name}};
    const std::int64_t rays = is_sanitized ? 80'000 : 800'000;
    Solver solver(scene, {.method = find_method(GetParam()), .limits = {.rays = rays}});
    solver.advance({.rays = rays / 2});
    solver.set_dimming("lamp", 0.5f);
    solver.advance({});
    const PowerBalance balance = power_balance(solver.scene(), solver.solution());
    EXPECT_NEAR(balance.emitted.x, 500 * 4 * 3 / 9.0, 1e-2);
    EXPECT_NEAR(balance.relative_difference(), 0, 5e-3);
}

/// A point light over a floor, half of it under a pane of glass. Seen to fail without the pane's transmittance
/// (transmitted light would count as absorbed by the pane) and without the escaped power.
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
