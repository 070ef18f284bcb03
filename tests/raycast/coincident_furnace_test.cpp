// Effect of coincident faces on the light of a closed room; coincident_test.cpp describes how these tests were seen to
// fail.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

// A furnace: exitance M and reflectance rho everywhere, so B = M / (1 - rho).
constexpr float exitance = 2, rho = 0.5f;
const Material wall{"wall", Rgb(rho), Rgb(exitance)};

SolveOptions furnace_options(std::uint64_t seed) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 200'000;
    options.seed = seed;
    return options;
}

float radiosity(const Solution& solution, PatchIndex patch) { return exitance + rho * solution.irradiance[patch].x; }

// The room's floor is the middle of a larger black slab. Every ray for which the slab is reported would be lost.
TEST(CoincidentFurnace, FloorInABlackSlabLosesNoLight) {
    Scene scene;
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0));
    add_rectangle(scene, {-1, -1, 0}, {4, 0, 0}, {0, 5, 0}, black);
    const std::uint32_t paint = add_material(scene, wall.reflectance, wall.exitance);
    const V3f x(1, 0, 0), y(0, 2, 0), z(0, 0, 3), o(0, 0, 0);
    const PatchIndex floor = add_rectangle(scene, o, x, y, paint, 3, 3);
    add_rectangle(scene, o, y, z, paint);
    add_rectangle(scene, x, z, y, paint);
    add_rectangle(scene, o, z, x, paint);
    add_rectangle(scene, y, x, z, paint);
    add_rectangle(scene, z, y, x, paint);

    std::vector<std::vector<double>> samples(9);
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        const Solution solution = solve(scene, RayCaster(scene), furnace_options(seed));
        EXPECT_EQ(solution.irradiance[0], Rgb(0));
        EXPECT_EQ(solution.iterations.back().escaped_rays, 0);
        for (std::uint32_t i = 0; i < 9; ++i) samples[i].push_back(radiosity(solution, floor + i));
    }
    std::vector<double> p_values, p_values_of_one_percent;
    for (const std::vector<double>& sample : samples) {
        p_values.push_back(t_test(sample, exitance / (1 - rho)));
        p_values_of_one_percent.push_back(t_test(sample, 1.01 * exitance / (1 - rho)));
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
    EXPECT_LT(bonferroni(p_values_of_one_percent), false_alarm);
}

double emitted(const Solution& solution) { return solution.emitted_power.x; }

enum class Copy { same_corners, other_first_corner, in_quarters };
void PrintTo(Copy copy, std::ostream* out) {
    constexpr std::array names{"same_corners", "other_first_corner", "in_quarters"};
    *out << names.at(static_cast<std::size_t>(copy));
}

void double_walls(Scene& scene, Copy copy) {
    const std::vector<Patch> walls = scene.patches;
    for (Patch doubled : walls) {
        const auto corner = [&](std::size_t i) { return scene.vertices[doubled.vertices[i]]; };
        if (copy == Copy::in_quarters) {
            add_rectangle(scene, corner(0), corner(1) - corner(0), corner(3) - corner(0), doubled.material, 2, 2);
            continue;
        }
        if (copy == Copy::other_first_corner)
            std::rotate(doubled.vertices.begin(), doubled.vertices.begin() + 1, doubled.vertices.end());
        scene.patches.push_back(doubled);
    }
}

class DoubledWalls : public testing::TestWithParam<Copy> {};
INSTANTIATE_TEST_SUITE_P(Copies, DoubledWalls,
                         testing::Values(Copy::same_corners, Copy::other_first_corner, Copy::in_quarters),
                         testing::PrintToStringParamName());

// The reported faces have B = M / (1 - rho), and only one of each pair emits power. Seen to fail, with twice the light,
// when Materials does not use uncovered_share().
TEST_P(DoubledWalls, OfAFurnaceEmitOnce) {
    Scene scene = closed_box({1, 2, 3}, 1, {wall});
    double_walls(scene, GetParam());
    for (const bool copies_first : {false, true}) {
        if (copies_first) std::reverse(scene.patches.begin(), scene.patches.end());
        const RayCaster ray_caster(scene);
        for (const char* method : {"srr", "wdrs", "random-walk", "photon-mesh"})
            for (std::uint64_t seed = 1; seed <= 4; ++seed) {
                SolveOptions options = furnace_options(seed);
                options.method = find_method(method);
                const Solution solution = solve(scene, ray_caster, options);
                EXPECT_NEAR(emitted(solution), exitance * 22, 1e-4);  // a box of 1 x 2 x 3 m has 22 m^2
                double power = 0, area = 0;
                for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
                    if (ray_caster.uncovered_share(i) == 0) {
                        EXPECT_EQ(solution.irradiance[i], Rgb(0)) << i;
                        continue;
                    }
                    power += static_cast<double>(radiosity(solution, i) * solution.forest->area(i));
                    area += solution.forest->area(i);
                }
                EXPECT_NEAR(area, 22, 1e-4);
                // All power is received, so almost the only noise of the mean is that of Russian roulette.
                EXPECT_NEAR(power / area, exitance / (1 - rho), 0.01 * exitance / (1 - rho)) << method;
            }
    }
}

TEST(DoubledWalls, OfAFurnaceEmitOnceWithLinks) {
    Scene scene = closed_box({1, 2, 3}, 1, {wall});
    double_walls(scene, Copy::in_quarters);
    SolveOptions options = furnace_options(1);
    options.method = find_method("hr");
    options.experimental.epsilon = 1e-3;
    const Solution solution = solve(scene, RayCaster(scene), options);
    EXPECT_NEAR(emitted(solution), exitance * 22, 1e-4);
    EXPECT_NEAR(radiosity(solution, PatchIndex(0)), exitance / (1 - rho), 0.1 * exitance / (1 - rho));
}

// The lamp comes after a face of the same corners without emission.
TEST(Lamp, CoincidentWithAnEarlierFaceLightsTheRoom) {
    std::vector<double> apart, together;
    for (const bool coincides : {false, true}) {
        Scene scene = closed_box({1, 2, 3}, 1, {{"wall", Rgb(rho), Rgb(0)}});
        const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(100));
        const V3f corner(0.2f, 0.2f, coincides ? 2.5f : 2.498f);
        const std::uint32_t shade = add_material(scene, Rgb(0), Rgb(0));
        add_rectangle(scene, {0.2f, 0.2f, 2.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, shade, 1, 1, true);
        add_rectangle(scene, corner, {0, 0.5f, 0}, {0.5f, 0, 0}, lamp);  // faces down
        const RayCaster ray_caster(scene);
        for (std::uint64_t seed = 1; seed <= 16; ++seed) {
            const Solution solution = solve(scene, ray_caster, furnace_options(seed));
            EXPECT_NEAR(emitted(solution), 25, 1e-4);
            (coincides ? together : apart).push_back(solution.irradiance[4].x);
        }
    }
    // It is 2 mm farther from the floor, which reduces the direct light by 0.2%. Without the lamp the room is dark.
    const auto mean = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0) / 16; };
    EXPECT_NEAR(mean(together) / mean(apart), 1, 0.01);
}

// The covered part of the floor, 0.05% of the surface, does not emit.
TEST(CoincidentFurnace, DecalOnAFloorGetsItsLight) {
    Scene scene = closed_box({1, 2, 3}, 1, {wall});
    const PatchIndex decal = add_rectangle(scene, {0.4f, 0.9f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, 0);
    std::vector<double> sample;
    for (std::uint64_t seed = 1; seed <= 64; ++seed)
        sample.push_back(radiosity(solve(scene, RayCaster(scene), furnace_options(seed)), PatchIndex(decal)));
    EXPECT_GT(t_test(sample, exitance / (1 - rho)), false_alarm);
    EXPECT_LT(t_test(sample, 1.05 * exitance / (1 - rho)), false_alarm);
    EXPECT_LT(t_test(sample, 0.95 * exitance / (1 - rho)), false_alarm);
}

}  // namespace
}  // namespace interflect
