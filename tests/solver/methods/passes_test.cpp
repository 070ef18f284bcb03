// Passes trace light from the emitters bounce by bounce, and random walks complete them. Each is an unbiased estimate
// of all bounces on the current mesh. References are dense solutions, which are exact in an empty box, and a furnace,
// where irradiance is M / (1 - rho) everywhere. Correct code fails a test with probability 0.001 (statistics.h), unless
// stated otherwise; seeds are fixed.
//
// Seen to fail if unshot irradiance of a pass is dropped, if it is passed on without the ratio of the passes' rays
// (TotalPower, FurnaceOfPasses), if every bounce emits, or if passes are averaged with equal weights.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <ostream>

#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/solve.h"
#include "tests/support/form_factors.h"
#include "tests/support/parameter_names.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

struct Flat {
    const char* method;
    PointSet points;
};
std::ostream& operator<<(std::ostream& out, const Flat& flat) { return out << flat.method; }

SolveOptions default_options(const Flat& flat, std::int64_t rays, std::uint64_t seed) {
    SolveOptions options{.method = find_method(flat.method)};
    options.views = {{into_the_corner}};
    options.experimental.points = flat.points;
    options.limits.rays = rays;
    options.seed = seed;
    return options;
}

class Passes : public testing::TestWithParam<Flat> {};
INSTANTIATE_TEST_SUITE_P(Flat, Passes,
                         testing::Values(Flat{"srr", PointSet::sobol}, Flat{"srr", PointSet::random},
                                         Flat{"isrr", PointSet::sobol}, Flat{"isrr", PointSet::random}),
                         [](const auto& test) {
                             return std::string(test.param.method) +
                                    (test.param.points == PointSet::sobol ? "_sobol" : "_random");
                         });

TEST_P(Passes, HaveTheDenseSolutionAsTheirMean) {
    constexpr std::uint64_t runs = 32;
    const Scene scene = colourful_box();
    const RayCaster ray_caster(scene);
    const std::vector<RgbD> exact = dense_irradiance(scene, exact_form_factors(scene));
    std::vector<std::vector<double>> values(3 * exact.size());
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution s = solve(scene, ray_caster, default_options(GetParam(), 60'000, seed));
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i].push_back(s.irradiance[i / 3][static_cast<int>(i % 3)]);
    }
    const auto p_value = [&](double factor) {
        std::vector<double> p_values;
        for (std::size_t i = 0; i < values.size(); ++i)
            p_values.push_back(t_test(values[i], factor * exact[i / 3][static_cast<int>(i % 3)]));
        return bonferroni(p_values);
    };
    EXPECT_GT(p_value(1), false_alarm);
    EXPECT_LT(p_value(1.04), false_alarm) << "would notice four percent";
}

/// Returns a closed box with this mean reflectance. Each wall has its own reflectance; one wall emits.
Scene box_of_walls(float rho) {
    const float spread = std::min(0.15f, 0.6f * (1 - rho));
    std::vector<Material> walls;
    for (const float way : {-1.0f, 1.0f, 0.5f, -0.5f, 0.8f, -0.8f})
        walls.push_back({"wall", Rgb(rho + way * spread), Rgb(0)});
    walls[4].exitance = Rgb(10);
    return closed_box({1, 2, 3}, 3, walls);
}

double mean_of(const std::vector<double>& x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double deviation_of(const std::vector<double>& x) {
    double square = 0;
    for (const double value : x) square += std::pow(value - mean_of(x), 2);
    return std::sqrt(square / static_cast<double>(x.size() - 1));
}

class TotalPower : public testing::TestWithParam<float> {};  // mean reflectance
INSTANTIATE_TEST_SUITE_P(Rho, TotalPower, testing::Values(0.5f, 0.8f, 0.92f, 0.97f), printed_name);

TEST_P(TotalPower, IsUnbiasedAndItsDeviationFallsAsTheRootOfTheRays) {
    constexpr std::uint64_t runs = 40;
    constexpr std::int64_t few = 16'000, many = 256'000;
    const Scene scene = box_of_walls(GetParam());
    const RayCaster ray_caster(scene);
    const std::vector<RgbD> irradiance = dense_irradiance(scene, exact_form_factors(scene));
    double exact = 0;
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
        const Material& m = scene.materials[scene.patches[i].material];
        exact += patch_area(scene, scene.patches[i]) *
                 (static_cast<double>(m.exitance.x) + static_cast<double>(m.reflectance.x) * irradiance[i].x);
    }
    const auto powers = [&](std::int64_t rays) {
        std::vector<double> values;
        for (std::uint64_t seed = 1; seed <= runs; ++seed)
            values.push_back(solve(scene, ray_caster, default_options({"srr", PointSet::random}, rays, seed))
                                 .iterations.back()
                                 .total_power.x /
                             exact);
        return values;
    };
    const std::vector<double> with_few = powers(few), with_many = powers(many);
    const auto expect_unbiased = [&](const std::vector<double>& values, std::int64_t rays) {
        const double error = deviation_of(values) / std::sqrt(static_cast<double>(runs));
        EXPECT_NEAR(mean_of(values), 1, 3.3 * error) << rays;
    };
    expect_unbiased(with_few, few);
    expect_unbiased(with_many, many);
    EXPECT_LT(t_test(with_many, 1.005), false_alarm) << "would notice half a percent";
    // The logarithm of a ratio of two deviations of 40 values has a standard deviation of 0.16. The tolerance is 3.3
    // times this.
    const double ratio = deviation_of(with_few) / deviation_of(with_many);
    EXPECT_NEAR(std::log(ratio), std::log(4.0), 3.3 * 0.16) << ratio;
}

TEST(FurnaceOfPasses, IsRightAtAnyDistanceFromAnEdgeAndInElementsOfAnySize) {
    constexpr std::uint64_t runs = 8;
    constexpr std::array<float, 4> distances{0.01f, 0.04f, 0.15f, 1};  // from the nearest edge, up to [m]
    constexpr int levels = 12;
    const Scene scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(1)}});  // H = M / (1 - rho) = 2
    const RayCaster ray_caster(scene);
    std::array<std::vector<double>, distances.size()> by_distance;
    std::array<std::vector<double>, levels> by_level;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        SolveOptions options{.method = find_method("hsrr")};
        options.limits.rays = 2'000'000;
        options.seed = seed;
        const Solution s = solve(scene, ray_caster, options);
        std::array<std::array<double, 2>, distances.size()> distance_sums{};
        std::array<std::array<double, 2>, levels> level_sums{};
        for (const ElementIndex e : s.forest->leaves()) {
            const Parameters p = s.forest->cell(e).centre(false);
            const float d = std::min({p.u, 1 - p.u, p.v, 1 - p.v});
            const auto within =
                static_cast<std::size_t>(std::upper_bound(distances.begin(), distances.end(), d) - distances.begin());
            const double area = s.forest->area(e), power = area * static_cast<double>(s.irradiance[e].x);
            for (auto* sums : {&distance_sums[within], &level_sums.at(static_cast<std::size_t>(s.forest->level(e)))})
                (*sums)[0] += power, (*sums)[1] += area;
        }
        const auto enter = [](auto& classes, const auto& sums) {
            for (std::size_t c = 0; c < classes.size(); ++c)
                if (sums[c][1] > 0) classes[c].push_back(sums[c][0] / sums[c][1]);
        };
        enter(by_distance, distance_sums);
        enter(by_level, level_sums);
    }
    std::vector<double> p_values;
    for (const std::vector<double>& means : by_distance)
        if (means.size() > 2) p_values.push_back(t_test(means, 2));
    const std::size_t of_distance = p_values.size();
    for (const std::vector<double>& means : by_level)
        if (means.size() > 2) p_values.push_back(t_test(means, 2));
    EXPECT_GE(of_distance, 2u);
    EXPECT_GE(p_values.size() - of_distance, 2u) << "elements of several sizes";
    EXPECT_GT(bonferroni(p_values), false_alarm);
    for (const std::vector<double>& means : by_distance)
        if (means.size() > 2) {
            EXPECT_NEAR(mean_of(means), 2, 0.02);
        }
    EXPECT_LT(t_test(by_distance.back(), 2.01), false_alarm) << "would notice half a percent in the middle";
}

}  // namespace
}  // namespace interflect
