// The furnace: a closed box with exitance M and reflectance rho everywhere. The form factors of a patch sum to 1, so H
// = B = M + rho H and B = M / (1 - rho). Before the limit, Eq. 6 gives the exact expected value of each iteration. The
// box has 1 x 2 x 3 m and 3 x 3 patches per wall. In a cube with 2 x 2 patches per wall, all 24 patches are congruent,
// and wrong directions or starting points would not be noticed.
//
// Seen to fail (scripts/mutation-test) if radiosity lacks rho, the incremental start has rho twice, irradiance or power
// lacks the area, a payload lacks q, rays are allocated uniformly, 0.5% of the power is lost, directions lack the
// cosine or cover an azimuth of only 6 radians, origins cluster near the centre, tau is always 1/2, or streams do not
// advance.

#include <gtest/gtest.h>

#include <cmath>

#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "tests/support/parameter_names.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr double exitance = 2.0;  // M [W/m^2]
constexpr int warm_up = 4, averaged = 4, runs = 64;
constexpr double float_rounding = 1e-5;  // relative rounding error of sums of floats

Scene furnace(double rho) {
    return closed_box({1, 2, 3}, 3, {{"wall", Rgb(static_cast<float>(rho)), Rgb(static_cast<float>(exitance))}});
}

/// Returns H after all iterations by Eq. 6, with form factors that sum to 1. Tends to M / (1 - rho).
double expected_irradiance(double rho) {
    double irradiance = 0.0;
    for (int k = 1; k <= warm_up + averaged; ++k) {
        const double tau = k <= warm_up ? 1.0 : 1.0 / (k - warm_up);
        irradiance += tau * (exitance + rho * irradiance - irradiance);
    }
    return irradiance;
}

SolveOptions paper_options(std::uint64_t seed) {
    SolveOptions options{.method = find_method("srr")};
    options.experimental.one_bounce = true;
    options.experimental.warm_up = warm_up;
    options.experimental.iterations = averaged;
    options.experimental.rays_per_iteration = 10'000;
    options.seed = seed;
    return options;
}

double area_weighted_mean(const Solution& solution) {
    const std::vector<Rgb> ones(solution.irradiance.size(), Rgb(1));
    return integral(*solution.forest, solution.irradiance).x / integral(*solution.forest, ones).x;
}

struct Runs {
    std::vector<std::vector<double>> irradiance;  // [patch][run]
    std::vector<double> area_mean, plain_mean;    // [run], over the patches

    template <class Options>
    Runs(const Scene& scene, const Options& options_of_seed) : irradiance(scene.patches.size()) {
        const RayCaster ray_caster(scene);
        for (std::uint64_t seed = 1; seed <= runs; ++seed) {
            const Solution solution = solve(scene, ray_caster, options_of_seed(seed));
            EXPECT_EQ(solution.iterations.back().escaped_rays + solution.non_finite, 0);
            area_mean.push_back(area_weighted_mean(solution));
            plain_mean.push_back(0);
            for (std::size_t i = 0; i < irradiance.size(); ++i) {
                const double h = solution.irradiance[i].x;
                irradiance[i].push_back(h);
                plain_mean.back() += h / static_cast<double>(irradiance.size());
            }
        }
    }

    /// Returns the p-value of the hypothesis that every patch has the expected value `expected`. Patches of one run are
    /// correlated.
    double p_value(double expected) const {
        std::vector<double> p_values;
        for (const std::vector<double>& patch : irradiance) p_values.push_back(t_test(patch, expected));
        return bonferroni(p_values);
    }
};

class Furnace : public testing::TestWithParam<double> {};  // rho
INSTANTIATE_TEST_SUITE_P(Rho, Furnace, testing::Values(0.0, 0.1, 0.5, 0.9, 0.95), printed_name);

TEST_P(Furnace, IsUnbiasedAndWouldNoticeOnePercent) {
    const double rho = GetParam(), expected = expected_irradiance(rho);
    const Runs sample(furnace(rho), paper_options);

    EXPECT_GT(sample.p_value(expected), false_alarm);
    EXPECT_LT(sample.p_value(1.01 * expected), false_alarm);

    // All rays have the same payload and none escapes, so the area-weighted mean has no noise.
    for (const double mean : sample.area_mean) EXPECT_NEAR(mean / expected, 1, float_rounding);
    // The plain mean over the patches has noise, and must lie within three standard errors.
    constexpr double three_standard_errors = 0.0027;  // p-value of a normal variable at three standard deviations
    EXPECT_GT(t_test(sample.plain_mean, expected), three_standard_errors);
}

TEST_P(Furnace, HasTheSameAnswerWithTheDefaultStart) {
    const double rho = GetParam(), limit = exitance / (1 - rho);
    const Runs sample(furnace(rho), [](std::uint64_t seed) {
        SolveOptions options{.method = find_method("srr")};
        options.limits.rays = 100'000;
        options.seed = seed;
        return options;
    });
    // Passes are complete. Only random walks cause noise in this room.
    EXPECT_GT(t_test(sample.area_mean, limit), false_alarm);
    EXPECT_LT(t_test(sample.area_mean, 0.998 * limit), false_alarm) << "would notice 0.2%";
    EXPECT_GT(sample.p_value(limit), false_alarm);
    EXPECT_LT(sample.p_value(1.01 * limit), false_alarm);
}

TEST(Furnace, WeighsEveryIterationByItsRays) {
    // The mean has no noise, so the power after each iteration shows its weight: tau = N_m / (N_1 + ... + N_m).
    constexpr double rho = 0.5;
    SolveOptions options{.method = find_method("srr")};
    options.experimental.one_bounce = true;
    options.experimental.warm_up = 2;
    options.limits.rays = 1'000'000;
    const Solution solution = solve(furnace(rho), RayCaster(furnace(rho)), options);
    const double surface = solution.emitted_power.x / exitance;
    const auto& iterations = solution.iterations;
    ASSERT_GT(iterations.size(), 6u);
    EXPECT_GT(iterations[6].rays - iterations[5].rays, iterations[4].rays - iterations[3].rays) << "they grow";
    double irradiance = 0;
    for (std::size_t k = 0; k < iterations.size(); ++k) {
        const auto merged_rays = static_cast<double>(iterations[k].rays - (k < 2 ? 0 : iterations[1].rays));
        const auto rays = static_cast<double>(iterations[k].rays - (k == 0 ? 0 : iterations[k - 1].rays));
        const double tau = k < 2 ? 1 : rays / merged_rays;
        irradiance += tau * (exitance + rho * irradiance - irradiance);
        EXPECT_NEAR(iterations[k].total_power.x / (surface * (exitance + rho * irradiance)), 1, float_rounding) << k;
    }
}

TEST(Furnace, RadiosityOfBlackWallsIsTheirExitanceExactly) {
    const Scene scene = furnace(0);
    const Solution solution = solve(scene, RayCaster(scene), paper_options(1));
    for (const Rgb& b : radiosity(Materials(scene), *solution.forest, solution.irradiance))
        EXPECT_EQ(b, Rgb(static_cast<float>(exitance)));
}

// The furnace for all stochastic_variants(): six walls, which hierarchical methods divide into 8 x 8 leaves each.
class DeepFurnace : public testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(All, DeepFurnace, testing::ValuesIn(stochastic_variants()),
                         [](const auto& test) { return test.param.name; });

TEST_P(DeepFurnace, HasTheSameIrradianceEverywhere) {
    constexpr double rho = 0.5;
    constexpr std::uint64_t seeds = 16;
    constexpr std::size_t walls = 6, all_elements = walls * (1 + 4 + 16 + 64);
    const bool refines = GetParam().options.method.refines;
    const Scene scene = closed_box({1, 2, 3}, 1, {{"wall", Rgb(rho), Rgb(exitance)}});
    const RayCaster ray_caster(scene);
    std::vector<std::vector<double>> leaves, patches(walls);  // [leaf or patch][run]
    std::vector<double> area_mean;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SolveOptions options = GetParam().options;
        options.views = {{into_the_corner}};
        options.experimental.one_bounce = true;
        options.experimental.warm_up = warm_up;
        options.experimental.iterations = averaged;
        options.experimental.rays_per_iteration = 10'000;
        options.seed = seed;
        divide_everything(options, 0.03f);  // m^2; the walls have 2, 3 and 6
        const Solution solution = solve(scene, ray_caster, options);
        ASSERT_EQ(solution.forest->size(), refines ? all_elements : walls);
        const std::vector<ElementIndex> places = leaves_by_place(*solution.forest);
        leaves.resize(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) leaves[i].push_back(solution.irradiance[places[i]].x);
        for (std::size_t w = 0; w < walls; ++w) patches[w].push_back(solution.irradiance[w].x);
        area_mean.push_back(area_weighted_mean(solution));
    }

    const auto p_value = [](const std::vector<std::vector<double>>& values, double expected) {
        std::vector<double> p_values;
        for (const std::vector<double>& v : values) p_values.push_back(t_test(v, expected));
        return bonferroni(p_values);
    };
    const double expected = expected_irradiance(rho);
    EXPECT_GT(p_value(leaves, expected), false_alarm);
    EXPECT_LT(p_value(leaves, 1.1 * expected), false_alarm) << "would notice ten percent in a leaf";
    EXPECT_GT(p_value(patches, expected), false_alarm);
    EXPECT_LT(p_value(patches, 1.01 * expected), false_alarm) << "would notice one percent in a wall";
    if (GetParam().options.method.importance != ImportanceUse::off) return;
    for (const double mean : area_mean) EXPECT_NEAR(mean / expected, 1, float_rounding) << "all rays carry the same";
}

// A closed room of surface S and reflectance rho, with one luminaire of power Phi. All emitted and reflected light is
// received, so S E = Phi + rho S E for any objects in the room.
class ClosedRoom : public testing::TestWithParam<double> {};  // rho
INSTANTIATE_TEST_SUITE_P(Rho, ClosedRoom, testing::Values(0.0, 0.5, 0.9, 0.95), printed_name);

TEST_P(ClosedRoom, HasTheMeanIrradianceOfItsPowerBalance) {
    const double rho = GetParam();
    const Rgb reflectance(static_cast<float>(rho));
    Scene scene = closed_box({5, 4, 2.5f}, 3, {{"wall", reflectance, Rgb(0)}});
    const std::uint32_t lamp = add_material(scene, reflectance, {300, 200, 100});
    scene.patches[5 * 9 + 4].material = lamp;                                         // the middle of the ceiling
    add_rectangle(scene, {2, 1, 0.5f}, {1, 0, 0}, {0, 2, 0.5f}, 0, 1, 1, true);       // a slanting table
    add_rectangle(scene, {1, 1, 0}, {0, 1, 0}, {0.25f, 0.25f, 1.5f}, 0, 2, 2, true);  // a leaning board

    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 200'000;
    const Solution solution = solve(scene, RayCaster(scene), options);
    double surface = 0;
    for (const Patch& patch : scene.patches) surface += patch_area(scene, patch);
    const double expected = solution.emitted_power.x / (surface * (1 - rho));
    EXPECT_EQ(solution.iterations.back().escaped_rays, 0);
    EXPECT_NEAR(area_weighted_mean(solution) / expected, 1, 1e-3 + float_rounding);
}

}  // namespace
}  // namespace interflect
