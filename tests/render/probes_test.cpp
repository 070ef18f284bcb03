// Irradiance probes against light with known harmonics.
//
// Seen to fail with unweighted facets, with x and y swapped, without a rotation, and when walls do not hide lamps.
#include "interflect/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interflect/core.h"
#include "interflect/render/sphere_quadrature.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
constexpr auto float_pi = std::numbers::pi_v<float>;

ProbeGrid probes(const Scene& scene, const ProbeOptions& options = {}) {
    SolveOptions solve_options;
    solve_options.limits.rays = 200'000;
    const RayCaster ray_caster(scene);
    return irradiance_probes(scene, solve(scene, ray_caster, solve_options), ray_caster, options);
}

Scene open_space() {
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {0, 0, -1000}, {0.01f, 0, 0}, {0, 0.01f, 0}, add_material(scene, Rgb(0), Rgb(0)));
    add_rectangle(scene, {0, 0, 1}, {0, 0.001f, 0}, {0.001f, 0, 0}, 0);
    return scene;
}

TEST(SphereQuadrature, IntegratesProductsOfHarmonicsExactly) {
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
            double sum = 0;
            for (const auto& [direction, weight] : sphere_quadrature(4)) {
                const auto basis = spherical_harmonics(direction);
                sum += weight * basis[static_cast<std::size_t>(i)] * basis[static_cast<std::size_t>(j)];
            }
            EXPECT_NEAR(sum, i == j, 1e-5) << i << " " << j;
        }
}

/// In a closed box of exitance M and reflectance 0, radiance is M / pi: E(n) = M, and all coefficients but Y00 vanish.
TEST(Probes, OfAFurnaceAreUniform) {
    const Scene scene = closed_box({1, 2, 3}, 1, {{"wall", Rgb(0), Rgb(1, 2, 4)}});
    const ProbeGrid grid = probes(scene, {.spacing = 1});
    ASSERT_EQ(grid.count, (std::array{1, 2, 3}));
    ASSERT_EQ(grid.probes.size(), 6u);
    EXPECT_EQ(grid.first, Imath::V3d(0.5, 0.5, 0.5));
    EXPECT_EQ(grid.step, Imath::V3d(1, 1, 1));
    for (const IrradianceProbe& probe : grid.probes) {
        EXPECT_FALSE(probe.is_inside);
        EXPECT_LT(probe.standard_error, 0.1f);
        const float tolerance = 5 * probe.standard_error;  // false alarm: 1e-6 for each of 72 comparisons
        for (int c = 0; c < 3; ++c) {
            const float exitance = static_cast<float>(1 << c);
            EXPECT_NEAR(probe.coefficients[0][c], exitance * std::sqrt(4 * float_pi),
                        std::sqrt(4 * float_pi) * exitance * tolerance);
            EXPECT_NEAR(probe.irradiance(V3f(0.6f, 0, -0.8f))[c], exitance, 3 * exitance * tolerance);
        }
    }
}

/// Parallel light of irradiance E from direction w: E_lm = A_l Y_lm(w) E. The nine terms give E (1/4 + 1/2 + 5/16) =
/// 17/16 E facing it, and E (1/4 - 1/2 + 5/16) = E / 16 away from it (Ramamoorthi and Hanrahan 2001).
void expect_parallel_light(const IrradianceProbe& probe, const V3f& towards, float irradiance) {
    const auto basis = spherical_harmonics(towards);
    const std::array factors{float_pi, 2 * float_pi / 3, float_pi / 4};
    for (std::size_t k = 0; k < 9; ++k) {
        const bool is_exact = k > 0 && k < 4;
        EXPECT_NEAR(probe.coefficients[k].y,
                    irradiance * basis[k] *
                        factors[k == 0  ? 0
                                : k < 4 ? 1
                                        : 2],
                    (is_exact ? 1e-4f : 0.013f * std::sqrt(4 * float_pi)) * irradiance)
            << k;
    }
    EXPECT_NEAR(probe.irradiance(towards).y, irradiance * 17 / 16, 0.013f * irradiance);
    EXPECT_NEAR(probe.irradiance(-towards).y, irradiance / 16, 0.013f * irradiance);
    EXPECT_NEAR(probe.standard_error, 0.0018f * irradiance, 2e-4f * irradiance);
    EXPECT_FALSE(probe.is_inside);
}

TEST(Probes, OfParallelLightHaveItsHarmonics) {
    Scene scene = open_space();
    const V3f towards = V3f(1, 2, 2) / 3;
    scene.luminaires = {{"sun", 0, DirectionalLight{-towards, Rgb(3, 6, 9)}}};
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
        expect_parallel_light(probes(scene, {.spacing = 1e4f, .rays = 8, .seed = seed}).probes[0], towards, 6);
}

/// 1e-4 m^2 of 1000 lm/m^2 at 5 m, facing the probe: M A / (pi d^2). Rays from the probe meet such a lamp once in three
/// million.
TEST(Probes, OfASmallLampHaveItsHarmonics) {
    Scene scene = closed_box({10, 10, 10}, 1, {{"wall", Rgb(0), Rgb(0)}});
    add_rectangle(scene, {4.995f, 4.995f, 9.999f}, {0, 0.01f, 0}, {0.01f, 0, 0},
                  add_material(scene, Rgb(0), Rgb(1e3f)));
    const IrradianceProbe probe = probes(scene, {.spacing = 1e4f}).probes[0];
    expect_parallel_light(probe, {0, 0, 1}, 1e3f * 1e-4f / (float_pi * 4.999f * 4.999f));
}

/// Root mean square deviation of E(n) over all normals. With 400 probes the ratio has a standard error of about 3%.
TEST(Probes, StateTheErrorOfSampling) {
    RELEASE_ONLY();  // see Probes.OfParallelLightHaveItsHarmonics
    Scene scene = closed_box({4, 3, 2.5f}, 1, {{"wall", Rgb(0.6f), Rgb(0)}});
    add_rectangle(scene, {1, 1, 2.49f}, {0, 0.6f, 0}, {0.6f, 0, 0}, add_material(scene, Rgb(0), Rgb(100)));
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.limits = {.rays = 200'000}});
    const auto probe = [&](std::uint64_t seed, int rays) {
        return irradiance_probes(scene, solution, ray_caster, {.spacing = 1e4f, .rays = rays, .seed = seed}).probes[0];
    };
    const IrradianceProbe truth = probe(1000, 1 << 19);
    double deviation = 0, stated = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        const IrradianceProbe p = probe(seed, 256);
        stated += p.standard_error * p.standard_error;
        for (std::size_t k = 0; k < 9; ++k) {
            const Rgb difference = (p.coefficients[k] - truth.coefficients[k]) / std::sqrt(4 * float_pi);
            deviation += difference.x * difference.x;
        }
    }
    EXPECT_NEAR(std::sqrt(stated / deviation), 1, 0.2);
}

/// A hemisphere of radiance L above the horizon, 0 below: E(up) = pi L, E(down) = 0 and E(sideways) = pi L / 2. Degrees
/// 0 to 2 are exact: higher odd degrees have no weight, and the next even degree of a hemisphere vanishes.
TEST(Probes, OfASkyOverBlackGroundTellUpFromDown) {
    Scene scene = closed_box({1e3f, 1e3f, 1}, 1, {{"wall", Rgb(0), Rgb(0)}});
    scene.patches.resize(5);  // without the ceiling
    scene.luminaires = {{"sky", 0, UniformSky{Rgb(1)}}};
    const IrradianceProbe probe = probes(scene, {.spacing = 1e4f, .rays = 20'000}).probes[0];
    EXPECT_NEAR(probe.irradiance({0, 0, 1}).x, float_pi, 0.02f);
    EXPECT_NEAR(probe.irradiance({0, 0, -1}).x, 0, 0.02f);
    EXPECT_NEAR(probe.irradiance({1, 0, 0}).x, float_pi / 2, 0.02f);
    EXPECT_NEAR(probe.irradiance({0, 1, 0}).x, float_pi / 2, 0.02f);
}

TEST(Probes, DoNotSeeLampsBehindWalls) {
    Scene scene = closed_box({2, 1, 1}, 1, {{"wall", Rgb(0), Rgb(0)}});
    add_rectangle(scene, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0, 1, 1, true);
    scene.luminaires = {{"lamp", 0, PointLight{{0.75f, 0.5f, 0.5f}, Rgb(1)}}};
    const ProbeGrid grid = probes(scene, {.spacing = 1, .rays = 8});
    ASSERT_EQ(grid.probes.size(), 2u);
    EXPECT_NEAR(grid.probes[0].irradiance({1, 0, 0}).x, 16 * 17 / 16.0f, 0.013f * 16) << "1 cd in 0.25 m";
    EXPECT_EQ(grid.probes[1].coefficients[0], Rgb(0));
    EXPECT_FALSE(grid.probes[0].is_inside);
    EXPECT_TRUE(grid.probes[1].is_inside) << "in the dark";
}

TEST(Probes, AreFlaggedInsideSolids) {
    Scene scene = closed_box({3, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(1)}});
    add_box(scene, {1.2f, 0.1f, 0.1f}, {1.8f, 0.9f, 0.9f}, 0);
    const ProbeGrid grid = probes(scene, {.spacing = 1, .rays = 128});
    ASSERT_EQ(grid.probes.size(), 3u);
    EXPECT_FALSE(grid.probes[0].is_inside);
    EXPECT_TRUE(grid.probes[1].is_inside);
    EXPECT_FALSE(grid.probes[2].is_inside);
}

TEST(Probes, RefuseOptionsOutOfRange) {
    const Scene scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0), Rgb(1)}});
    for (const ProbeOptions& options : {ProbeOptions{.spacing = 0}, ProbeOptions{.spacing = std::nanf("")},
                                        ProbeOptions{.spacing = 0.001f}, ProbeOptions{.rays = 7}})
        EXPECT_THROW(probes(scene, options), InputError);
}

}  // namespace
}  // namespace interflect
