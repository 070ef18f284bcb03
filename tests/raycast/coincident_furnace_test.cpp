// What coincident faces do to the light of a closed room: coincident_test.cpp tells how these tests were seen to fail.

#include <gtest/gtest.h>

#include "interflect/raycast/ray_caster.h"
#include "interflect/solver/solve.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

// A furnace: exitance M and reflectance rho everywhere, so B = M / (1 - rho).
constexpr float exitance = 2, rho = 0.5f;
const Material wall{"wall", Rgb(rho), Rgb(exitance)};

SolveOptions furnace_options(std::uint64_t seed) {
    SolveOptions options;
    options.rays = 200'000;
    options.seed = seed;
    return options;
}

float radiosity(const Solution& solution, std::uint32_t patch) { return exitance + rho * solution.irradiance[patch].x; }

// The room's floor is the middle of a larger black slab. Every ray that the slab answered would be lost.
TEST(CoincidentFurnace, FloorInABlackSlabLosesNoLight) {
    Scene scene;
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0));
    add_rectangle(scene, {-1, -1, 0}, {4, 0, 0}, {0, 5, 0}, black);
    const std::uint32_t paint = add_material(scene, wall.reflectance, wall.exitance);
    const V3f x(1, 0, 0), y(0, 2, 0), z(0, 0, 3), o(0, 0, 0);
    const std::uint32_t floor = add_rectangle(scene, o, x, y, paint, 3, 3);
    add_rectangle(scene, o, y, z, paint), add_rectangle(scene, x, z, y, paint), add_rectangle(scene, o, z, x, paint);
    add_rectangle(scene, y, x, z, paint), add_rectangle(scene, z, y, x, paint);

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

// What is under the decal still emits, which adds the decal's share of the surface, 0.05%, to the light in the room.
TEST(CoincidentFurnace, DecalOnAFloorGetsItsLight) {
    Scene scene = closed_box({1, 2, 3}, 1, {wall});
    const std::uint32_t decal = add_rectangle(scene, {0.4f, 0.9f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, 0);
    std::vector<double> sample;
    for (std::uint64_t seed = 1; seed <= 64; ++seed)
        sample.push_back(radiosity(solve(scene, RayCaster(scene), furnace_options(seed)), decal));
    EXPECT_GT(t_test(sample, exitance / (1 - rho)), false_alarm);
    EXPECT_LT(t_test(sample, 1.05 * exitance / (1 - rho)), false_alarm);
    EXPECT_LT(t_test(sample, 0.95 * exitance / (1 - rho)), false_alarm);
}

}  // namespace
}  // namespace interflect
