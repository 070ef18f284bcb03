// Rays shot from skies, maps and the disc of the sun, against independent integrals of their radiance. Nothing
// reflects, so the irradiance of a patch is caused by the source alone.
//
// Seen to fail if a side of the scene's box lacks the cosine in its power or in its directions, if a map has the
// colours of its mean, or if the rays of a disc do not widen the rectangle on which they start.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interflect/base/numbers/random.h"
#include "interflect/luminaires/emission.h"
#include "interflect/measure.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "tests/support/rooms/room_with_window.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

using std::numbers::pi;
constexpr int runs = 12;
constexpr double integration_error = 2e-4;  // relative error of expected irradiances

SolveOptions options_of(std::uint64_t seed, std::int64_t rays) {
    SolveOptions options{.method = find_method("srr")};
    options.experimental.points = PointSet::random;
    options.limits.rays = rays;
    options.seed = seed;
    return options;
}

/// Returns the irradiance of every patch [patch][run] in one channel.
std::vector<std::vector<double>> solved(const Scene& scene, std::int64_t rays, int channel = 0) {
    const RayCaster ray_caster(scene);
    std::vector<std::vector<double>> irradiance(scene.patches.size());
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution solution = solve(scene, ray_caster, options_of(seed, rays));
        for (std::size_t i = 0; i < irradiance.size(); ++i)
            irradiance[i].push_back(static_cast<double>(solution.irradiance[i][channel]));
    }
    return irradiance;
}

class EverySky : public testing::TestWithParam<KnownSky> {};
INSTANTIATE_TEST_SUITE_P(All, EverySky, testing::ValuesIn(known_skies()), testing::PrintToStringParamName());

/// Tests a convex box lit from outside: each side has the irradiance of an open plane.
TEST_P(EverySky, LightsTheSidesOfABox) {
    Scene scene;
    scene.objects = {""};
    scene.luminaires = {GetParam().luminaire};
    add_material(scene, Rgb(0), Rgb(0));
    add_box(scene, {1, 2, 3}, {1.8f, 3, 3.5f}, 0);
    const auto found = solved(scene, 50'000);
    std::vector<double> p_values;
    const std::vector<Rectangle> sides = rectangles_of(scene);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const double expected = GetParam().irradiance(sides[i].normal());
        if (expected == 0)
            EXPECT_EQ(found[i][0], 0);
        else
            p_values.push_back(t_test(found[i], expected, integration_error * expected));
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

/// Received and escaped power equal the emitted power. This is exact in the sum of the channels, by which rays are
/// distributed over the parts of a sky.
TEST_P(EverySky, LosesNoPower) {
    Scene scene = room_with_window(Rgb(0));
    scene.luminaires = {GetParam().luminaire};
    SolveOptions options = options_of(1, 20'000);
    options.experimental.iterations = 1;
    const Solution solution = solve(scene, RayCaster(scene), options);
    const RgbD arrived = integral(*solution.forest, solution.irradiance);
    const RgbD expected = Emission(scene).total_power();
    const RgbD found = arrived + solution.iterations.back().escaped_power;
    EXPECT_NEAR(channel_sum(found) / channel_sum(expected), 1, 1e-5);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1, 0.01) << c;
}

/// Tests the light through a window on the floor of a black room.
TEST_P(EverySky, ShinesThroughAWindow) {
    Scene scene = room_with_window(Rgb(0));
    scene.luminaires = {GetParam().luminaire};
    const auto found = solved(scene, 200'000);
    const std::vector<Rectangle> patches = rectangles_of(scene);
    std::vector<double> p_values;
    for (std::size_t i = 0; i < 25; ++i) {
        const Rectangle& patch = patches[2 * i];
        double expected = 0;
        constexpr int n = 12, m = 24;
        for (int k = 0; k < n * n; ++k)
            for (int w = 0; w < m * m; ++w) {
                const V3d x = patch.corner + patch.u * ((k % n + 0.5) / n) + patch.v * ((k / n + 0.5) / n),
                          y(0, 1 + 1.5 * (w % m + 0.5) / m, 1 + 1.2 * (w / m + 0.5) / m), d = y - x;
                expected += GetParam().radiance(d.normalized()) * d.z * -d.x / std::pow(d.length2(), 2) *
                            (1.8 / (n * n * m * m));
            }
        if (expected < 1) continue;  // too few rays
        // The tolerance is the error of the integral at the edges of a map.
        p_values.push_back(t_test(found[2 * i], expected, 0.005 * expected));
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

/// Two texels of different colours light two sides of a box, each with its own colour.
TEST(EnvironmentMap, KeepsTheColoursOfItsTexels) {
    Scene scene;
    scene.objects = {""};
    const auto image = image_of(2, 1, {Rgb(10, 2, 0), Rgb(1, 5, 7)});
    scene.luminaires = {{"", 0, EnvironmentMap{image}}};
    add_material(scene, Rgb(0), Rgb(0));
    add_box(scene, {0, 0, 0}, {1, 1, 1}, 0);
    const std::vector<Rectangle> sides = rectangles_of(scene);
    for (int c = 0; c < 3; ++c) {
        const auto found = solved(scene, 30'000, c);
        std::vector<double> p_values;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const double west = static_cast<double>(image->texels[0][c]),
                         east = static_cast<double>(image->texels[1][c]);
            const double x = sides[i].normal().x, expected = pi * (x > 0.5    ? east
                                                                   : x < -0.5 ? west
                                                                              : (east + west) / 2);
            if (expected > 0)
                p_values.push_back(t_test(found[i], expected));
            else
                EXPECT_EQ(found[i][0], 0);
        }
        EXPECT_GT(bonferroni(p_values), false_alarm) << c;
    }
}

/// A disc of 40 degrees over an edge: in the penumbra, each patch receives light from the part of the disc that it
/// sees. For a horizontal plane, this part is an area in the unit circle (Nusselt), where the edge is an ellipse.
TEST(Disc, HasAPenumbra) {
    const double radius = std::sin(20 * pi / 180), height = 0.8;
    Scene scene;
    scene.objects = {""};
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0));
    add_rectangle(scene, {-1, -0.1f, 0}, {2, 0, 0}, {0, 0.2f, 0}, black, 20, 1);
    add_rectangle(scene, {-3, -3, static_cast<float>(height)}, {3, 0, 0}, {0, 6, 0}, black, 1, 1, true);  // x < 0
    scene.luminaires = {{"", 0, DirectionalLight{{0, 0, -1}, Rgb(100), 40}}};
    const auto found = solved(scene, 300'000);
    std::vector<double> p_values;
    for (std::size_t i = 0; i < 20; ++i) {
        constexpr int steps = 200, places = 40;
        double expected = 0;
        for (int place = 0; place < places; ++place) {
            const double x = -1 + 0.1 * (static_cast<double>(i) + (place + 0.5) / places), slope = -x / height;
            for (int k = 0; k < steps; ++k) {
                const double y = radius * (2 * (k + 0.5) / steps - 1), half = std::sqrt(radius * radius - y * y);
                const double edge = std::copysign(std::sqrt(slope * slope * (1 - y * y) / (1 + slope * slope)), slope);
                expected += std::max(0.0, half - std::max(edge, -half)) * 2 * radius / steps / places;
            }
        }
        expected *= 100 / (pi * radius * radius);
        if (expected < 0.5) {
            EXPECT_LT(found[i][0], 2);
        } else {
            p_values.push_back(t_test(found[i], expected, 1e-3 * expected));
        }
    }
    EXPECT_GT(p_values.size(), 10u);
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

/// In a small reflecting room, lit by a clear sky and the sun through a window, the solver's irradiance of patches must
/// equal the path tracer's.
TEST(Daylight, IsTheSameToSolverAndPathTracer) {
    Scene scene = room_with_window(Rgb(0));
    scene.materials[0].reflectance = Rgb(0.5f);
    const V3f towards = V3f(-1.2f, 0.3f, 1).normalized();
    scene.luminaires = {{"sky", 0, SkyDome{cie_standard_sky(12), Rgb(1000), {0, 0, 1}, towards, 0.2f}},
                        {"sun", 0, DirectionalLight{-towards, Rgb(3000), 5}}};
    const auto found = solved(scene, 400'000);
    const std::vector<Rectangle> patches = rectangles_of(scene);
    const RayCaster ray_caster(scene);
    std::vector<MeasuringPoint> points;
    std::vector<double> p_values;
    constexpr int places = 64;
    const std::vector<std::size_t> chosen{0, 12, 24, 36, 50, 54};
    for (const std::size_t i : chosen)
        for (int k = 0; k < places; ++k) {
            const auto a = random_words(5, static_cast<std::uint64_t>(k));
            const V3d x = patches[i].corner + patches[i].u * static_cast<double>(unit_float(a[0])) +
                          patches[i].v * static_cast<double>(unit_float(a[1]));
            points.push_back({x, V3f(patches[i].normal())});
        }
    const auto traced =
        measure_irradiance(scene, nullptr, ray_caster, points, {.shading = Shading::path, .samples = 1024});
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        double sum = 0, squares = 0;
        for (int k = 0; k < places; ++k) {
            const double e = traced[i * places + static_cast<std::size_t>(k)].sum().x;
            sum += e / places;
            squares += e * e / places;
        }
        const double error = std::sqrt((squares - sum * sum) / (places - 1));
        p_values.push_back(t_test(found[chosen[i]], sum, error));
        EXPECT_LT(error, 0.15 * sum) << i;
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

}  // namespace
}  // namespace interflect
