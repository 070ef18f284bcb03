// The direct part of irradiance, which passes keep apart: the light of their first bounce. Correct code fails a test
// with probability 0.001 (statistics.h); seeds are fixed.
//
// Seen to fail if the direct part includes the second bounce, if it is not merged with earlier passes, and if dimming
// does not scale it. In passes of a few rays it included the light of random walks: the direct light of the maze was
// 48% too bright with 30 rays.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

const View into_the_corner{"corner", {0.9f, 1.9f, 2.5f}, {0.1f, 0.4f, 0.2f}, {0, 0, 1}, 40};

SolveOptions options_of(const std::string& method, std::int64_t rays, std::uint64_t seed = 1) {
    SolveOptions options{.method = find_method(method)};
    options.limits.rays = rays;
    options.seed = seed;
    options.keep_direct = options.method.separates_direct;
    if (options.method.importance != ImportanceUse::off) options.views = {{into_the_corner}};
    return options;
}

RgbD power(const Solution& solution, const std::vector<Rgb>& irradiance) {
    RgbD sum(0, 0, 0);
    for (PatchIndex i{0}; i < solution.forest->patch_count(); ++i)
        sum += RgbD(irradiance[i]) * static_cast<double>(solution.forest->area(i));
    return sum;
}

class DirectLightOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, DirectLightOf, testing::Values("srr", "isrr", "hsrr", "ihsrr"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(DirectLightOf, IsAllThatASourceEmitsInAClosedRoom) {
    constexpr double rounding = 1e-3;
    const Scene scene = furnished_room();
    const Solution solution = solve(scene, RayCaster(scene), options_of(GetParam(), 300'000));
    ASSERT_EQ(solution.direct.size(), 1u);
    const RgbD direct = power(solution, solution.direct[0]), all = power(solution, solution.irradiance);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(direct[c], solution.emitted_power[c], rounding * solution.emitted_power[c]);
        EXPECT_GT(all[c], 1.1 * direct[c]);
    }
}

/// All rays from one emitter carry the same power, so the direct power is exact for any number of rays.
TEST(DirectLight, ExcludesTheRandomWalksOfPassesOfFewRays) {
    constexpr double rounding = 1e-3;
    std::vector<Material> walls(6, {"wall", Rgb(0.8f), Rgb(0)});
    walls[4].exitance = Rgb(10);
    const Scene scene = closed_box({1, 2, 3}, 1, walls);
    for (const std::int64_t rays : {1, 2, 10, 40, 100}) {
        SolveOptions options = options_of("srr", rays);
        options.experimental.shrinkage = options.experimental.clusters = false;
        const Solution solution = solve(scene, RayCaster(scene), options);
        ASSERT_EQ(solution.direct.size(), 1u);
        const double direct = power(solution, solution.direct[0]).x, all = power(solution, solution.irradiance).x;
        EXPECT_NEAR(direct, solution.emitted_power.x, rounding * solution.emitted_power.x) << rays << " rays";
        EXPECT_GT(all, 1.1 * direct) << rays << " rays";
    }
}

TEST(DirectLight, HasTheFirstBounceAsItsMean) {
    constexpr std::uint64_t runs = 32;
    const Scene scene = colourful_box();
    const RayCaster ray_caster(scene);
    const FormFactors form_factors = exact_form_factors(scene);
    const ElementForest forest(scene, scene.patches.size());
    std::vector<std::vector<double>> values(3 * scene.patches.size());
    std::vector<double> exact(values.size(), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (PatchIndex j{0}; j < scene.patches.size(); ++j)
            exact[i] +=
                form_factors(i / 3, j) *
                static_cast<double>(scene.materials[scene.patches[j].material].exitance[static_cast<int>(i % 3)]);
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution s = solve(scene, ray_caster, options_of("isrr", 60'000, seed));
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i].push_back(s.direct[0][i / 3][static_cast<int>(i % 3)]);
    }
    const auto p_value = [&](double factor) {
        std::vector<double> p_values;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (exact[i] > 0) p_values.push_back(t_test(values[i], factor * exact[i]));
        return bonferroni(p_values);
    };
    EXPECT_GT(p_value(1), false_alarm);
    EXPECT_LT(p_value(1.04), false_alarm) << "would notice four percent";
}

/// The furnished room with its two materials that emit in light groups of their own.
Scene room_with_groups() {
    Scene scene = furnished_room();
    std::vector<std::size_t> emitting;
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (channel_sum(scene.materials[m].exitance) > 0) emitting.push_back(m);
    for (const std::size_t m : emitting) {
        scene.materials[m].name = "lamp" + std::to_string(m);
        scene.light_groups.push_back({scene.materials[m].name, scene.materials[m].name});
    }
    return scene;
}

TEST(DirectLight, FollowsLightGroupsAndDimming) {
    constexpr double rounding = 1e-3;
    const auto scene = std::make_shared<const Scene>(room_with_groups());
    const std::string group = scene->light_groups.front().name;
    Solver solver(scene, options_of("hsrr", 300'000));
    solver.advance({});
    const Solution before = solver.solution();
    ASSERT_EQ(before.direct.size(), before.groups.size());
    solver.set_dimming(group, 3);
    const Solution after = solver.solution();
    for (int c = 0; c < 3; ++c) {
        const double emitted = power(before, before.direct[0])[c];
        EXPECT_NEAR(power(after, after.direct[0])[c], 3 * emitted, 3 * rounding * emitted);
    }
    Scene dimmed_scene = *scene;
    Solution dimmed_solution = before;
    dim(dimmed_scene, dimmed_solution, group, 3);
    for (std::size_t e = 0; e < before.direct[0].size(); ++e)
        EXPECT_EQ(dimmed_solution.direct[0][e], before.direct[0][e] * 3.0f);
}

TEST(DirectLight, IsZeroInLeavesOfMethodsThatDoNotKeepItApart) {
    const Scene scene = furnished_room();
    const Solution solution = solve(scene, RayCaster(scene), options_of("hwdrs", 100'000));
    EXPECT_TRUE(solution.direct.empty());
    for (const Leaf& leaf : leaves(scene, solution)) EXPECT_EQ(leaf.direct, Rgb(0));
}

}  // namespace
}  // namespace interflect
