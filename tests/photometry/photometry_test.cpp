// Summaries of measured points, and a point light over a floor in closed form.

#include "interflect/measure.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

MeasuredIrradiance grey(float direct, float indirect, float error) {
    return {Rgb(direct), Rgb(indirect), Rgb(error), error};
}

TEST(Summary, IsThatOfTheSums) {
    const std::vector<MeasuredIrradiance> measured{grey(100, 50, 3), grey(200, 100, 4), grey(40, 20, 1),
                                                   grey(300, 90, 2)};
    const IlluminanceSummary s = summarise(measured);
    EXPECT_EQ(s.points, 4u);
    EXPECT_NEAR(s.mean, 225, 1e-3);
    EXPECT_NEAR(s.min, 60, 1e-3);
    EXPECT_NEAR(s.min_error, 1, 1e-6);
    EXPECT_NEAR(s.max, 390, 1e-3);
    EXPECT_NEAR(s.uniformity(), 60.0 / 225, 1e-6);
    EXPECT_NEAR(s.diversity(), 60.0 / 390, 1e-6);
    EXPECT_NEAR(s.mean_error, std::sqrt(9.0 + 16 + 1 + 4) / 4, 1e-6);
    EXPECT_EQ(summarise({}).points, 0u);
    EXPECT_EQ(summarise({}).uniformity(), 0);
}

TEST(Summary, WeighsColours) {
    const std::vector<MeasuredIrradiance> green{{Rgb(0, 10, 0), Rgb(0), Rgb(0, 1, 0), 0}};
    EXPECT_NEAR(summarise(green).mean, 7.152, 1e-4);
    EXPECT_NEAR(summarise(green).mean_error, 0.7152, 1e-5);
}

/// By hand: a tenth of the indirect light is missing everywhere.
TEST(SolutionError, IsTheDifferenceFromPathTracing) {
    const std::vector<MeasuredIrradiance> gathered{grey(100, 50, 0), grey(10, 100, 0), grey(0, 30, 0)};
    const std::vector<MeasuredIrradiance> traced{grey(100, 55, 0), grey(10, 110, 0), grey(0, 33, 0)};
    const SolutionError e = estimate_solution_error(gathered, std::array<std::size_t, 3>{0, 1, 2}, traced);
    EXPECT_NEAR(e.mean, 6, 1e-4);
    EXPECT_NEAR(e.relative, 0.1, 1e-5);
    EXPECT_NEAR(e.at(gathered[1]), 10, 1e-3);
    const IlluminanceSummary s = summarise(gathered, e);
    EXPECT_NEAR(s.mean_solution_error, 6, 1e-4);
    EXPECT_NEAR(s.min_solution_error, 3, 1e-4);

    // One point represents all three; their individual errors are independent of it.
    const SolutionError of_one = estimate_solution_error(gathered, std::array<std::size_t, 1>{1}, {&traced[1], 1});
    EXPECT_NEAR(of_one.mean, std::sqrt(100 + 100 * 2.0 / 3), 1e-3);
}

/// Equal values show an error below the resolution of the comparison, 5 lx a point.
TEST(SolutionError, IsAtLeastHalfTheResolution) {
    const std::vector<MeasuredIrradiance> gathered(4, grey(100, 50, 3)), traced(4, grey(100, 50, 4));
    const SolutionError e = estimate_solution_error(gathered, std::array<std::size_t, 4>{0, 1, 2, 3}, traced);
    EXPECT_NEAR(e.mean, std::sqrt(4 * 25 / 2.0) / 4, 1e-5);
    EXPECT_NEAR(e.relative, std::sqrt(std::sqrt(4 * 625 / 2.0) / (4 * 2500)), 1e-6);
}

TEST(SolutionError, NeedsPointsThatWereMeasuredAndReflectedLight) {
    const std::array<std::size_t, 1> first{0};
    const std::vector<MeasuredIrradiance> lit{grey(100, 50, 3)}, direct{grey(100, 0, 3)},
        lost{grey(0, 0, std::numeric_limits<float>::infinity())};
    EXPECT_TRUE(std::isnan(estimate_solution_error(lit, first, lost).mean));
    EXPECT_TRUE(std::isnan(estimate_solution_error(lost, first, lit).relative));
    EXPECT_EQ(estimate_solution_error(direct, first, direct).mean, 0);
}

TEST(ExteriorIlluminance, IsThatOfTheUniformSkyWithoutTheSun) {
    Scene scene = closed_box({1, 1, 1}, 1, {Material{}});
    EXPECT_FALSE(exterior_illuminance(scene));
    scene.luminaires.push_back({"sky", 0, UniformSky{Rgb(1000)}});
    EXPECT_NEAR(*exterior_illuminance(scene), 1000 * std::numbers::pi, 0.01);
    EXPECT_FALSE(has_other_light_than_sky(scene));
    scene.luminaires.push_back({"sun", 0, DirectionalLight{{0, 0, -1}, Rgb(80'000)}});
    EXPECT_NEAR(*exterior_illuminance(scene), 1000 * std::numbers::pi, 0.01);
    EXPECT_TRUE(has_other_light_than_sky(scene));
}

/// For a map: pi L sin^2 of the angle to the lower edge of its only bright row; the part below the horizon is ignored.
TEST(ExteriorIlluminance, AddsDomesAndMaps) {
    Scene scene = closed_box({1, 1, 1}, 1, {Material{}});
    scene.luminaires.push_back({"overcast", 0, SkyDome{cie_standard_sky(1), Rgb(5000), {0, 0, 1}, {0, 0, 1}, 0.5f}});
    EXPECT_NEAR(*exterior_illuminance(scene), 5000, 0.01);
    const Texture up_to_45_degrees{"", 1, 4, {Rgb(0, 100, 0), Rgb(0), Rgb(7), Rgb(7)}};
    scene.luminaires.push_back({"map", 0, EnvironmentMap{.image = std::make_shared<Texture>(up_to_45_degrees)}});
    EXPECT_NEAR(*exterior_illuminance(scene), 5000 + 71.52 * std::numbers::pi / 2, 0.01);
    EXPECT_FALSE(has_other_light_than_sky(scene));
}

/// E = I cos / r^2 = I h / r^3 at every point of a grid on a black floor; 0 on the averted side.
TEST(MeasuringGrid, MeasuresThePointLightOverIt) {
    Scene scene = closed_box({6, 5, 3}, 1, {Material{"", Rgb(0), Rgb(0)}});
    scene.objects = {"", "floor"};
    scene.patches[4].object = 1;
    scene.luminaires.push_back({"lamp", 0, PointLight{{2, 2, 2.5f}, Rgb(1000)}});
    const MeasuringGrid grid = area_grid(scene, find_top(scene, "floor"));
    std::vector<MeasuringPoint> points;
    for (const Imath::V3d& p : grid.points) points.push_back({p, grid.normal});
    points.push_back({{2, 3, 1}, -grid.normal});
    const auto measured =
        measure_irradiance(scene, nullptr, RayCaster(scene), points, {.shading = Shading::path, .samples = 64});
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        const double r = (grid.points[i] - Imath::V3d(2, 2, 2.5)).length(), expected = 1000 * 2.5 / (r * r * r);
        EXPECT_NEAR(static_cast<double>(measured[i].illuminance()), expected, 1e-3 * expected);
        EXPECT_TRUE(measured[i].is_measured());
    }
    EXPECT_EQ(measured.back().illuminance(), 0);
}

TEST(MeasureIrradiance, TellsWhatAnInterruptionHasNotReached) {
    const Scene scene = closed_box({6, 5, 3}, 1, {Material{"", Rgb(0.5f), Rgb(10)}});
    const std::atomic<bool> stop = true;
    const auto measured =
        measure_irradiance(scene, nullptr, RayCaster(scene), std::vector<MeasuringPoint>{{{1, 1, 1}}},
                           {.shading = Shading::path, .samples = 64}, {.on_progress = {}, .stop = &stop});
    ASSERT_EQ(measured.size(), 1u);
    EXPECT_FALSE(measured.front().is_measured());
}

}  // namespace
}  // namespace interflect
