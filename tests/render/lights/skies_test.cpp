// Skies, environment maps and the sun in path tracing, gathering and pictures, against independent integrals of the
// same radiance.
//
// Seen to fail in each of these cases: the density of a direction lacks its cell's solid angle; escaped rays have full
// weight besides the samples of a sky; a sky's samples lack the cosine or 1/pi; rows of a map are weighted without the
// sine of their angle; a dome is not normalised; the sun's samples lack the ratio of its two solid angles.
#include "interflect/luminaires/skies/skies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/measure.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

using std::numbers::pi;

/// A black plate that hides a hundred-thousandth of the sphere from the origin.
Scene under(const std::vector<Luminaire>& luminaires) {
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {-0.05f, -0.05f, -10}, {0.1f, 0, 0}, {0, 0.1f, 0}, add_material(scene, Rgb(0), Rgb(0)));
    scene.luminaires = luminaires;
    return scene;
}

const std::vector<V3f> normals{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-0.5f, -0.6f, 0.3f}, {0.1f, 0.2f, -1}};

std::vector<MeasuredIrradiance> measured(const Scene& scene, int samples, Shading shading = Shading::path) {
    const RayCaster ray_caster(scene);
    std::optional<Solution> solution;
    if (needs_solution(shading))
        solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 1000}});
    std::vector<MeasuringPoint> points;
    for (const V3f& n : normals) points.push_back({{0, 0, 0}, n});
    return measure_irradiance(scene, solution ? &*solution : nullptr, ray_caster, points,
                              {.shading = shading, .samples = samples});
}

class EverySky : public testing::TestWithParam<KnownSky> {};
INSTANTIATE_TEST_SUITE_P(All, EverySky, testing::ValuesIn(known_skies()), testing::PrintToStringParamName());

/// Planes that face up, sideways, aslant and down, by path tracing and gathering. Five standard errors: one test in
/// a million would fail by chance.
TEST_P(EverySky, CausesItsIrradiance) {
    const KnownSky& sky = GetParam();
    const Scene scene = under({sky.luminaire});
    std::vector<double> irradiance;
    for (const V3f& n : normals) irradiance.push_back(sky.irradiance(V3d(n.normalized())));
    for (const Shading shading : {Shading::path, Shading::gather}) {
        const auto found = measured(scene, 1 << 14, shading);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const double expected = irradiance[i], error = static_cast<double>(found[i].standard_error.x);
            EXPECT_NEAR(found[i].sum().x, expected, 5 * error + 3e-4 * expected + 1e-3) << i << " " << label(shading);
            EXPECT_LT(error, 0.025 * expected + 1e-3) << i;
        }
    }
    if (const auto* dome = std::get_if<SkyDome>(&sky.luminaire.kind); dome && dome->zenith.z > 0) {
        EXPECT_NEAR(irradiance[0] / static_cast<double>(rating(sky.luminaire).x), 1, 1e-3)
            << "the illuminance that was asked for";
    }
}

TEST_P(EverySky, IsSeenAsItIs) {
    const Scene scene = under({GetParam().luminaire});
    const RayCaster ray_caster(scene);
    const Skies skies(scene);
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const auto a = random_words(3, i);
        const float cosine = 2 * unit_float(a[0]) - 1, turn = 6.2831853f * unit_float(a[1]),
                    sine = std::sqrt(1 - cosine * cosine);
        const V3f d(sine * std::cos(turn), sine * std::sin(turn), cosine);
        const double expected = GetParam().radiance(V3d(d));
        EXPECT_NEAR(skies.radiance_with_suns(d).x, expected, 1e-3 * expected + 1e-4) << d;
    }
    const View view{"up", {0, 0, 0}, {0.3, -0.4, 1.1}, {0, 1, 0}, 0.01f};
    const double expected = GetParam().radiance(V3d(0.3, -0.4, 1.1).normalized());
    const Image traced =
        render(scene, ray_caster, view, {.width = 1, .height = 1, .shading = Shading::path, .samples = 8}).image;
    EXPECT_NEAR(traced.pixels[0].x, expected, 1e-3 * expected);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 1000}});
    const Image drawn =
        render(scene, solution, ray_caster, view, {.width = 1, .height = 1, .shading = Shading::smooth}).image;
    EXPECT_NEAR(drawn.pixels[0].x, expected, 1e-3 * expected);
}

/// Returns the frame of a sky, and a grid in it whose cells do not straddle the horizon or the edges of texels.
std::pair<SkyFrame, SkyGrid> frame_and_grid(const Luminaire& sky) {
    constexpr SkyGrid coarse{24, 12};
    const auto* map = std::get_if<EnvironmentMap>(&sky.kind);
    if (!map) return {SkyFrame(std::get<SkyDome>(sky.kind).zenith), coarse};
    const Texture& image = *map->image;
    return {SkyFrame(map->zenith, map->north),
            image.width > coarse.columns ? SkyGrid{image.width, image.height} : coarse};
}

/// The frequency of samples in each cell of a grid matches the integral of the density, which integrates to 1.
TEST_P(EverySky, IsSampledByItsDensity) {
    const Skies skies(under({GetParam().luminaire}));
    ASSERT_TRUE(skies.can_sample());
    const auto [frame, grid] = frame_and_grid(GetParam().luminaire);
    std::vector<double> observed(grid.size(), 0), expected(grid.size(), 0);
    constexpr int samples = 200'000, fine = 20;
    for (std::uint64_t i = 0; i < samples; ++i) {
        const auto a = random_words(11, i);
        const Skies::Sample s = skies.sample((a[0] + 0.5) * 0x1p-32, unit_float(a[1]), unit_float(a[2]));
        EXPECT_FLOAT_EQ(s.density, skies.density(s.direction));
        const SkyPlace place = frame.place(s.direction);
        ++observed[grid.row_of(place.cosine) * grid.columns + grid.column_of(place.s)];
    }
    double integral = 0;
    for (std::size_t row = 0; row < grid.rows; ++row)
        for (std::size_t column = 0; column < grid.columns; ++column)
            for (int i = 0; i < fine * fine; ++i) {
                const double upper = grid.edge_cosine(row), lower = grid.edge_cosine(row + 1);
                const SkyPlace place{(static_cast<float>(column) + (static_cast<float>(i % fine) + 0.5f) / fine) /
                                         static_cast<float>(grid.columns),
                                     static_cast<float>(upper + (lower - upper) * (i / fine + 0.5) / fine)};
                const double share =
                    static_cast<double>(skies.density(frame.direction(place))) * grid.solid_angle(row) / (fine * fine);
                expected[row * grid.columns + column] += samples * share;
                integral += share;
            }
    EXPECT_NEAR(integral, 1, 2e-3);
    double seldom_observed = 0, seldom_expected = 0;
    std::vector<double> often_observed, often_expected;
    constexpr double often = 20;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] >= often) {
            often_observed.push_back(observed[i]);
            often_expected.push_back(expected[i]);
        } else {
            seldom_observed += observed[i];
            seldom_expected += expected[i];
        }
    }
    EXPECT_NEAR(seldom_observed, seldom_expected, 5 * std::sqrt(seldom_expected));
    EXPECT_GT(chi_square_test(often_observed, often_expected), false_alarm);
}

TEST(EnvironmentMap, OfOneRadianceIsAUniformSky) {
    const auto image = image_of(7, 5, std::vector<Rgb>(35, Rgb(3, 2, 1)));
    const auto of_map = measured(under({{"", 0, EnvironmentMap{image}}}), 1 << 12);
    for (const MeasuredIrradiance& e : of_map) {
        EXPECT_NEAR(e.direct.x, 3 * pi, 5 * static_cast<double>(e.standard_error.x) + 1e-3);
        EXPECT_NEAR(e.direct.z, 1 * pi, 5 * static_cast<double>(e.standard_error.z) + 1e-3);
    }
}

/// One bright texel is parallel light of irradiance solid angle times radiance.
TEST(EnvironmentMap, WithOneBrightTexelIsParallelLight) {
    constexpr std::uint32_t width = 720, height = 360, row = 100, column = 500;
    std::vector<Rgb> texels(width * height, Rgb(0));
    texels[row * width + column] = Rgb(1000);
    const SkyGrid grid{width, height};
    const SkyFrame frame({0, 0, 1}, {0, 1, 0});
    const V3f towards = frame.direction(grid.middle(column, row));
    const float irradiance = 1000 * static_cast<float>(grid.solid_angle(row));
    const auto found = measured(under({{"", 0, EnvironmentMap{image_of(width, height, texels)}}}), 1024);
    const auto expected = measured(under({{"", 0, DirectionalLight{-towards, Rgb(irradiance)}}}), 1024);
    for (std::size_t i = 0; i < normals.size(); ++i)
        EXPECT_NEAR(found[i].direct.x, expected[i].direct.x, 2e-3 * irradiance) << i;
    EXPECT_GT(expected[1].direct.x, 0.1 * irradiance);
}

const Luminaire sun{"", 0, DirectionalLight{{-1, -0.5f, -1.5f}, {90, 80, 70}, 12}};

TEST(Sun, CausesItsIrradianceAndIsSeenAsADisc) {
    const Scene scene = under({sun});
    const auto found = measured(scene, 1 << 12);
    const V3f towards = V3f(1, 0.5f, 1.5f).normalized();
    for (std::size_t i = 0; i < 3; ++i) {  // the entire disc is above these planes
        EXPECT_NEAR(found[i].direct.x, 90 * normals[i].normalized().dot(towards),
                    5 * static_cast<double>(found[i].standard_error.x) + 1e-3)
            << i;
        EXPECT_LT(found[i].standard_error.x, 0.05f);
    }
    EXPECT_EQ(found[4].direct.x, 0);
    const Skies skies(scene);
    EXPECT_FALSE(skies.can_sample());
    const SkyFrame frame(towards);
    const double radiance = 90 / (pi * std::pow(std::sin(6 * pi / 180), 2));
    for (const double angle : {0.0, 3.0, 5.99, 6.01, 40.0, 180.0}) {
        const V3f d = frame.direction({0.3f, static_cast<float>(std::cos(angle * pi / 180))});
        EXPECT_NEAR(skies.radiance_with_suns(d).x, angle < 6 ? radiance : 0, 1e-4 * radiance) << angle;
        EXPECT_EQ(skies.radiance(d), Rgb(0));
    }
}

/// The real Sun's disc is 109 times as far away as it is wide: its penumbra under an edge at 1 m is 9.3 mm wide.
TEST(Sun, HasAPenumbra) {
    Scene scene = under({{"", 0, DirectionalLight{{0, 0, -1}, Rgb(80'000), sun_diameter}}});
    add_rectangle(scene, {-3, -3, 1}, {3, 0, 0}, {0, 6, 0}, 0, 1, 1, true);  // hides x < 0
    const RayCaster ray_caster(scene);
    const double radius = std::tan(0.533 / 2 * pi / 180);  // of the disc, as projected from the edge, at 1 m [m]
    std::vector<MeasuringPoint> points;
    const std::vector<double> offsets{-1.2, -0.95, -0.7, -0.3, 0, 0.5, 0.9, 1.2};  // in radii; the edge is at 0
    for (const double offset : offsets) points.push_back({{offset * radius, 0, 0}});
    const auto found =
        measure_irradiance(scene, nullptr, ray_caster, points, {.shading = Shading::path, .samples = 1 << 14});
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        // The disc's part beyond a chord: directions that lead to x > 0 at the edge's height pass the edge.
        const double t = std::clamp(offsets[i], -1.0, 1.0),
                     visible = 1 - (std::acos(t) - t * std::sqrt(1 - t * t)) / pi;
        EXPECT_NEAR(found[i].direct.x, 80'000 * visible, 5 * static_cast<double>(found[i].standard_error.x) + 80)
            << offsets[i];
        EXPECT_LT(found[i].standard_error.x, 500);
    }
}

/// The irradiance three metres below a skylight is the integral over the visible part of the sky.
TEST(SkyThroughAnOpening, IsTheIntegralOverIt) {
    RELEASE_ONLY();
    for (const KnownSky& sky : known_skies()) {
        Scene scene = under({sky.luminaire});
        const std::uint32_t black = 0;
        const auto roof = [&](V3f corner, V3f u, V3f v) { add_rectangle(scene, corner, u, v, black, 1, 1, true); };
        roof({-999, -999, 3}, {1998, 0, 0}, {0, 998, 0});  // an opening of 4 m x 2 m
        roof({-999, 1, 3}, {1998, 0, 0}, {0, 998, 0});
        roof({-999, -1, 3}, {997, 0, 0}, {0, 2, 0});
        roof({2, -1, 3}, {997, 0, 0}, {0, 2, 0});
        const RayCaster ray_caster(scene);
        const V3d x(0.5, -0.2, 0);
        const auto through = [&](const V3d& d) {
            const V3d p = d.z > 1e-9 ? x + d * (3 / d.z) : V3d(1e9);
            return std::abs(p.x) < 2 && std::abs(p.y) < 1 ? 1.0 : 0.0;
        };
        double expected = 0;
        constexpr int nx = 400, ny = 200;
        for (int i = 0; i < nx; ++i)
            for (int k = 0; k < ny; ++k) {
                const V3d d = V3d(-2 + 4 * (i + 0.5) / nx, -1 + 2 * (k + 0.5) / ny, 3) - x;
                expected += sky.radiance(d.normalized()) * 9 / std::pow(d.length2(), 2) * (8.0 / (nx * ny));
            }
        const auto found = measure_irradiance(scene, nullptr, ray_caster, std::vector<MeasuringPoint>{{x}},
                                              {.shading = Shading::path, .samples = 1 << 15});
        const double error = static_cast<double>(found[0].standard_error.x);
        EXPECT_NEAR(found[0].direct.x, expected, 5 * error + 2e-3 * expected + 0.05) << sky.name;
        EXPECT_LT(error, 0.02 * expected + 0.05) << sky.name;
        // All other surfaces are black: integral over the directions of the opening.
        const double by_hand = irradiance_of([&](const V3d& d) { return through(d) * sky.radiance(d); }, {0, 0, 1});
        EXPECT_NEAR(by_hand, expected, 0.01 * expected + 0.05) << sky.name;
    }
}

}  // namespace
}  // namespace interflect
