// Direct light of hybrid shading: unbiased for any number of samples, where occluders leave little of a lamp visible.
//
// Seen to fail: the unoccluded light times the visible share of the shadow rays (-96% with 2 samples, -48% with 64); no
// sum of f / p subtracted; counts of samples chosen by the samples of the gauge itself; one shadow ray for lamps and
// suns together.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/render/gauges/gauge_light.h"
#include "interflect/render/lights/unoccluded_light.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/shadings.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr float exitance = 1000, lamp_height = 3, plate_height = 2.8f, half_hole = 0.3f;

/// A black floor below a lamp of 8 x 8 m, most of which a plate with a square hole covers.
Scene below_a_plate(float h = half_hole) {
    Scene scene;
    scene.objects = {""};
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0));
    add_rectangle(scene, {-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, black);
    add_rectangle(scene, {-4, -4, lamp_height}, {0, 8, 0}, {8, 0, 0}, add_material(scene, Rgb(0), Rgb(exitance)));
    constexpr float wide = 6, z = plate_height;
    const auto add_plate = [&](const V3f& corner, float u, float v) {
        add_rectangle(scene, corner, {u, 0, 0}, {0, v, 0}, black, 1, 1, true);
    };
    add_plate({-wide, -wide, z}, wide - h, 2 * wide);
    add_plate({h, -wide, z}, wide - h, 2 * wide);
    add_plate({-h, -wide, z}, 2 * h, wide - h);
    add_plate({-h, h, z}, 2 * h, wide - h);
    return scene;
}

/// The lamp fills the hole.
double exact_irradiance(const V3f& x, float h = half_hole) {
    constexpr float z = plate_height;
    const std::array<V3f, 4> hole{V3f(-h, -h, z), V3f(-h, h, z), V3f(h, h, z), V3f(h, -h, z)};
    return static_cast<double>(exitance * polygon_irradiance(hole, x, V3f(0, 0, 1))) / std::numbers::pi;
}

std::vector<Gauge> gauges_on_floor(std::size_t count) {
    std::vector<Gauge> gauges;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto words = random_words(5, i);
        gauges.push_back({.position = {unit_float(words[0]) - 0.5f, unit_float(words[1]) - 0.5f, 0},
                          .normal = {0, 0, 1},
                          .patch = PatchIndex(0)});
    }
    return gauges;
}

/// Gauges in space, at most half a metre from x in both directions.
std::vector<Gauge> gauges_around(const V3f& x) {
    std::vector<Gauge> gauges = gauges_on_floor(2000);
    for (Gauge& g : gauges) {
        g.position += x;
        g.patch = no_patch;
    }
    return gauges;
}

/// Fixed counts, and counts that follow the noise.
class BelowAPlate : public testing::TestWithParam<std::tuple<int, double>> {};
INSTANTIATE_TEST_SUITE_P(SamplesAndTarget, BelowAPlate,
                         testing::Combine(testing::Values(2, 4, 16, 64), testing::Values(1e-9, 0.06)),
                         [](const auto& test) {
                             return std::to_string(std::get<0>(test.param)) +
                                    (std::get<1>(test.param) < 1e-3 ? "Fixed" : "Adaptive");
                         });

TEST_P(BelowAPlate, DirectLightIsUnbiased) {
    const auto [samples, target] = GetParam();
    RELEASE_ONLY_IF(samples > 2 || target < 1e-3);
    const Scene scene = below_a_plate();
    const RayCaster ray_caster(scene);
    const TracedScene traced(scene, ray_caster);
    const std::vector<Gauge> gauges =
        gauges_on_floor(static_cast<std::size_t>((is_sanitized ? 2000 : 200'000) / samples));
    const PictureOptions options{.samples = samples, .until = target, .quantity = PictureQuantity::irradiance};
    std::vector<double> ratios;
    double stated = 0, true_square = 0;
    const std::vector<SampledIrradiance> light = direct_irradiance(traced, gauges, options, {});
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double exact = exact_irradiance(gauges[i].position);
        ratios.push_back(static_cast<double>(light[i].irradiance.x) / exact);
        true_square += std::pow(ratios.back() - 1, 2);
        stated += static_cast<double>(light[i].squared_error) / (exact * exact);
    }
    RELEASE_ONLY();  // the statistics
    EXPECT_GT(t_test(ratios, 1), false_alarm);
    EXPECT_LT(t_test(ratios, 1.1), false_alarm) << "the test notices 10%";
    EXPECT_NEAR(std::sqrt(stated / true_square), 1, 0.1) << "the stated error is the true one";
}

/// At random heights, about a quarter of the points that share coefficients count as one surface, so few rays determine
/// the coefficients. Seen to fail with those of the same half.
TEST(DirectLight, IsUnbiasedWithFewSimilarPoints) {
    RELEASE_ONLY();                    // see BelowAPlate
    constexpr float wide_hole = 1.2f;  // the brightest part of the lamp is visible
    const Scene scene = below_a_plate(wide_hole);
    const RayCaster ray_caster(scene);
    const TracedScene traced(scene, ray_caster);
    std::vector<Gauge> gauges = gauges_on_floor(200'000);
    for (std::size_t i = 0; i < gauges.size(); ++i) {
        gauges[i].position.z = 0.05f + unit_float(random_words(6, i)[0]);
        gauges[i].patch = no_patch;
    }
    const PictureOptions options{.samples = 2, .quantity = PictureQuantity::irradiance};
    const std::vector<SampledIrradiance> light = direct_irradiance(traced, gauges, options, {});
    std::vector<double> ratios;
    for (std::size_t i = 0; i < light.size(); ++i)
        ratios.push_back(static_cast<double>(light[i].irradiance.x) / exact_irradiance(gauges[i].position, wide_hole));
    EXPECT_GT(t_test(ratios, 1), false_alarm);
    EXPECT_LT(t_test(ratios, 1.01), false_alarm) << "the test notices 1%";
}

/// The same for pixels.
TEST(Hybrid, DirectLightOfPixelsIsUnbiasedBelowAPlate) {
    RELEASE_ONLY();  // see Hybrid.SunOutsideAddsNoNoise
    Scene scene = below_a_plate();
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 10'000}});
    View view{"down", {0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 50};
    view.extent = 1;
    for (const int samples : {2, 4, 16}) {
        std::vector<double> ratios;
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
            const PictureOptions options{
                .width = 64, .height = 64, .samples = samples, .quantity = PictureQuantity::irradiance, .seed = seed};
            const Image seen =
                render(scene, solution, ray_caster, view, by(Shading::hybrid, options)).layers.reflected.direct;
            double sum = 0, exact = 0;
            for (int row = 0; row < 64; ++row)
                for (int column = 0; column < 64; ++column) {
                    const auto at = [](int i) { return (static_cast<float>(i) + 0.5f) / 64 - 0.5f; };
                    sum += static_cast<double>(seen.at(column, row).x);
                    exact += exact_irradiance({at(column), at(row), 0});
                }
            ratios.push_back(sum / exact);
        }
        EXPECT_GT(t_test(ratios, 1), false_alarm) << samples;
        EXPECT_LT(t_test(ratios, 1.2), false_alarm) << samples;
    }
}

/// Unoccluded light is the mean of the samples of all sources, also close to extended luminaires and with a sun on the
/// horizon. Seen to fail with the middles of 16 strata in place of random points.
TEST(UnoccludedLight, IsTheMeanOfTheSamples) {
    Scene scene = below_a_plate();
    auto web = std::make_shared<PhotometricWeb>();
    web->polar = {0, 45, 90}, web->azimuth = {0, 360};
    web->intensities = {300, 200, 0, 300, 200, 0};
    web->opening.size = {1.2f, 0.6f, 0};
    scene.luminaires.push_back({"panel", 0, MeasuredLight{web, {0.3f, 0.2f, 1}, {0, 0, -1}, {1, 0, 0}, false, Rgb(1)}});
    scene.luminaires.push_back({"point", 0, PointLight{{2, 0.5f, 2}, {50, 60, 70}}});
    DirectionalLight sun{{-1, 0, -0.3f}, Rgb(1000)};
    sun.diameter = 60;
    scene.luminaires.push_back({"sun", 0, sun});
    std::vector<PatchGeometry> geometry;
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    const LightSources sources(scene, geometry);
    const UnoccludedLight unoccluded(scene, geometry);
    const std::vector<std::uint8_t> all_groups(unoccluded.group_count(), 1);
    const V3f x(0.1f, -0.3f, 0.6f);
    for (const V3f& n : {V3f(0, 0, 1), V3f(0.8f, 0, 0.6f)})
        for (const SourceKind kind : source_kinds) {
            ASSERT_TRUE(unoccluded.has(kind));
            const auto& [first, last] = unoccluded.groups_by_kind()[static_cast<std::size_t>(kind)];
            std::vector<double> differences, sums;
            for (std::uint64_t i = 0; i < 20'000; ++i) {
                const auto a = random_words(3, i), b = random_words(4, i);
                const LightSample numbers{(a[0] + 0.5) * 0x1p-32, unit_float(a[1]), unit_float(a[2]), unit_float(a[3])};
                std::vector<Rgb> by_group(unoccluded.group_count(), Rgb(0));
                unoccluded.add(x, n, unit_float(b[0]), unit_float(b[1]), all_groups, by_group);
                const Rgb all = std::accumulate(by_group.begin() + static_cast<std::ptrdiff_t>(first),
                                                by_group.begin() + static_cast<std::ptrdiff_t>(last), Rgb(0));
                differences.push_back(static_cast<double>(sources.sample(kind, x, n, numbers).irradiance.x - all.x));
                sums.push_back(static_cast<double>(all.x));
            }
            EXPECT_GT(t_test(differences, 1e-6 * sums[0]), false_alarm) << static_cast<int>(kind);
            EXPECT_LT(t_test(differences, 0.03 * sums[0]), false_alarm) << static_cast<int>(kind);
        }
}

/// No source is missing in the groups.
TEST(UnoccludedLight, GroupsNearSources) {
    Scene scene = closed_box({4, 3, 2.5f}, 1, {Material{"", Rgb(0.5f)}});
    const std::uint32_t bright = add_material(scene, Rgb(0), Rgb(1000));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> panels;  // first and last patch
    for (int panel = 0; panel < 20; ++panel) {
        const auto first = static_cast<std::uint32_t>(scene.patches.size());
        const V3f corner(0.1f + 0.9f * static_cast<float>(panel % 4), 0.1f + 0.5f * static_cast<float>(panel / 4),
                         2.4f);
        add_rectangle(scene, corner, {0, 0.2f, 0}, {0.2f, 0, 0}, bright, 2, 2);
        panels.emplace_back(first, static_cast<std::uint32_t>(scene.patches.size()));
    }
    std::vector<PatchGeometry> geometry;
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    const UnoccludedLight unoccluded(scene, geometry);
    ASSERT_TRUE(unoccluded.has(SourceKind::patches));
    EXPECT_EQ(unoccluded.group_count(), UnoccludedLight::max_groups_of_kind);
    std::vector<int> patches(unoccluded.group_count(), 0);
    for (const auto& [first, last] : panels)
        for (std::uint32_t i = first; i < last; ++i) ++patches.at(unoccluded.group_of(SourceKind::patches, i));
    for (const int count : patches) EXPECT_GT(count, 0);
    const V3f below(2, 1.5f, 0), up(0, 0, 1);
    std::vector<Rgb> by_group(unoccluded.group_count(), Rgb(0));
    unoccluded.add(below, up, 0.5f, 0.5f, std::vector<std::uint8_t>(unoccluded.group_count(), 1), by_group);
    double expected = 0;
    for (const auto& [first, last] : panels)
        for (std::uint32_t i = first; i < last; ++i) {
            std::array<V3f, 4> corners;
            for (std::size_t k = 0; k < 4; ++k) corners[k] = scene.vertices[scene.patches[i].vertices[k]];
            expected += 1000 * static_cast<double>(polygon_irradiance(corners, below, up)) / std::numbers::pi;
        }
    const double sum = static_cast<double>(std::accumulate(by_group.begin(), by_group.end(), Rgb(0)).x);
    EXPECT_NEAR(sum, expected, 1e-4 * expected);
}

enum class Hidden { nothing, sun, lamp, patch };

/// A room with a box and a lamp; outside, a source that does not shine into the room.
Scene room_beside(Hidden hidden, bool has_patch) {
    Scene scene = closed_box({4, 3, 2.5f}, 2, {Material{"", Rgb(0)}});
    add_box(scene, {1, 1, 0}, {1.5f, 1.4f, 0.8f}, 0);
    for (Patch front : std::vector<Patch>(scene.patches.begin(), scene.patches.begin() + 24)) {
        std::swap(front.vertices[1], front.vertices[3]);  // opaque from outside
        scene.patches.push_back(front);
    }
    if (has_patch)
        add_rectangle(scene, {1.9f, 1.4f, 2}, {0, 0.2f, 0}, {0.2f, 0, 0}, add_material(scene, Rgb(0), Rgb(1e4f)));
    else
        scene.luminaires.push_back({"lamp", 0, PointLight{{2, 1.5f, 2}, Rgb(100)}});
    if (hidden == Hidden::sun) scene.luminaires.push_back({"sun", 0, DirectionalLight{{0.2f, 0.1f, -1}, Rgb(1e5f)}});
    if (hidden == Hidden::lamp) scene.luminaires.push_back({"hidden", 0, PointLight{{6, 2, 1.5f}, Rgb(1e6f)}});
    if (hidden == Hidden::patch)
        add_rectangle(scene, {6, 1, 1.5f}, {0, 0, 0.5f}, {0, 1, 0}, add_material(scene, Rgb(0), Rgb(1e8f)));
    return scene;
}

/// Four equal lamps in two rooms. Every place of a room sees its two lamps and not the others, so shadow rays add
/// little noise: 2.9%. Seen to fail with one coefficient for all lamps: 8.6%.
TEST(DirectLight, HasLittleNoiseWhereEachLampIsVisibleOrHidden) {
    Scene scene = closed_box({8, 3, 2.5f}, 1, {Material{"", Rgb(0)}});
    add_rectangle(scene, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5f}, 0, 1, 1, true);
    const std::uint32_t bright = add_material(scene, Rgb(0), Rgb(1000));
    std::vector<std::array<V3f, 4>> visible;
    for (int i = 0; i < 4; ++i) {
        const V3f corner(i < 2 ? 1.5f : 5.5f, i % 2 == 0 ? 0.6f : 2.2f, 2.4f);
        const V3f u(0, 0.2f, 0), v(0.2f, 0, 0);
        add_rectangle(scene, corner, u, v, bright);
        if (i >= 2) visible.push_back({corner, corner + u, corner + u + v, corner + v});
    }
    const RayCaster ray_caster(scene);
    const TracedScene traced(scene, ray_caster);
    const std::vector<Gauge> gauges = gauges_around({6, 1.5f, 0.01f});
    const PictureOptions options{.samples = 2, .quantity = PictureQuantity::irradiance};
    const auto light = direct_irradiance(traced, gauges, options, {});
    double squares = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        double exact = 0;
        for (const auto& lamp : visible)
            exact +=
                1000 * static_cast<double>(polygon_irradiance(lamp, gauges[i].position, {0, 0, 1})) / std::numbers::pi;
        squares += std::pow(static_cast<double>(light[i].irradiance.x) / exact - 1, 2);
    }
    const double noise = std::sqrt(squares / static_cast<double>(light.size()));
    EXPECT_LT(noise, 0.045) << "of the irradiance of a place";
}

/// Standard deviation of the direct irradiance of places beside the box [as H].
double noise_beside(Hidden hidden, bool has_patch, int samples) {
    const Scene scene = room_beside(hidden, has_patch);
    const RayCaster ray_caster(scene);
    const TracedScene traced(scene, ray_caster);
    const std::vector<Gauge> gauges = gauges_around({2.8f, 1.5f, 0.01f});
    PictureOptions options{.samples = samples, .quantity = PictureQuantity::irradiance};
    double squares = 0;
    const auto a = direct_irradiance(traced, gauges, options, {});
    options.seed = 2;
    const auto b = direct_irradiance(traced, gauges, options, {});
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += std::pow(static_cast<double>(a[i].irradiance.x - b[i].irradiance.x), 2);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

/// Seen to fail when both share their shadow rays.
TEST(Hybrid, SunOutsideAddsNoNoise) {
    EXPECT_LE(noise_beside(Hidden::sun, false, 4), 1.1 * noise_beside(Hidden::nothing, false, 4) + 1e-3);
}

/// A lamp keeps half of its shadow rays if sources behind a wall are 10,000 or 100,000 times brighter. The test rays
/// cannot exclude a few visible parts, so noise of 7% and 16% remains. Seen to fail without weights by visibility:
/// 1,500% and 5,300%.
TEST(Hybrid, BrightLampBehindAWallAddsLittleNoise) {
    const double of_lamp = 100 / (2 * 2.0), of_patch = 1e4 * 0.04 / (4 * std::numbers::pi);  // below them
    EXPECT_LT(noise_beside(Hidden::lamp, false, 16), 0.25 * of_lamp);
    EXPECT_LT(noise_beside(Hidden::patch, true, 16), 0.25 * of_patch);
}

}  // namespace
}  // namespace interflect
