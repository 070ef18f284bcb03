// The sky through a window, in hybrid shading: directions learned near records find it.
//
// Seen to fail: the density of guided rays ignores their number; escaped rays have full weight beside guided rays;
// densities lack the number of cells; no guide.
#include "interflect/render/paths/sky_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/ray_caster.h"
#include "interflect/render/gauges/gauge_light.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

using std::numbers::pi;
constexpr float room_height = 3;
constexpr float half_x = 0.5f, half_y = 0.25f;  // of the window

/// A wide black floor and a black ceiling with a window in the middle.
Scene below_a_window(const Luminaire& sky, bool has_glass) {
    Scene scene;
    constexpr float far = 1000;
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0));
    const auto add = [&](const V3f& corner, const V3f& u, const V3f& v, std::uint32_t material) {
        add_rectangle(scene, corner, u, v, material, 1, 1, true);
    };
    add({-far, -far, 0}, {2 * far, 0, 0}, {0, 2 * far, 0}, black);
    for (const float side : {-1.0f, 1.0f}) {
        add({-far, side < 0 ? -far : half_y, room_height}, {2 * far, 0, 0}, {0, far - half_y, 0}, black);
        add({side < 0 ? -far : half_x, -half_y, room_height}, {far - half_x, 0, 0}, {0, 2 * half_y, 0}, black);
    }
    if (has_glass) {
        const std::uint32_t glass = add_material(scene, Rgb(0), Rgb(0));
        scene.materials[glass].transmittance = Rgb(0.5f);
        add({-half_x, -half_y, room_height}, {2 * half_x, 0, 0}, {0, 2 * half_y, 0}, glass);
    }
    scene.luminaires = {sky};
    return scene;
}

/// Integral over the window by the midpoint rule.
double exact_irradiance(const KnownSky& sky, const V3d& x) {
    constexpr int nx = 200, ny = 100;
    double sum = 0;
    for (int i = 0; i < nx; ++i)
        for (int k = 0; k < ny; ++k) {
            const V3d through((2 * (i + 0.5) / nx - 1) * half_x, (2 * (k + 0.5) / ny - 1) * half_y, room_height);
            const V3d d = through - x;
            sum += sky.radiance(d.normalized()) * d.z * d.z / std::pow(d.length2(), 2);
        }
    return sum * 4 * half_x * half_y / (nx * ny);
}

constexpr int samples = 16;

/// Texels of 5 cm at random places on the floor.
std::vector<Gauge> texels_on_the_floor(std::uint64_t seed) {
    std::vector<Gauge> gauges;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const auto words = random_words(seed, i);
        const V3f place(4 * unit_float(words[0]) - 2, 4 * unit_float(words[1]) - 2, 0);
        gauges.push_back({.position = place,
                          .normal = {0, 0, 1},
                          .patch = PatchIndex(0),
                          .side_u = {0.05f, 0, 0},
                          .side_v = {0, 0.05f, 0}});
    }
    return gauges;
}

/// Exact irradiance of each texel through the open window.
std::vector<double> exact_irradiance(const KnownSky& sky, const std::vector<Gauge>& gauges) {
    std::vector<double> exact;
    for (const Gauge& gauge : gauges) exact.push_back(exact_irradiance(sky, V3d(gauge.position)));
    return exact;
}

/// Differences from the exact irradiance of texels, relative to its mean if some light arrives. `open` is their exact
/// irradiance without glass.
std::vector<double> errors_below(const KnownSky& sky, bool has_glass, std::uint64_t seed,
                                 const std::vector<Gauge>& gauges, const std::vector<double>& open) {
    const Scene scene = below_a_window(sky.luminaire, has_glass);
    const RayCaster ray_caster(scene);
    const ElementForest forest(scene, scene.patches.size());
    const std::vector<Rgb> dark(forest.size(), Rgb(0));
    const KnownIrradiance known{forest, dark, dark, true};
    const TracedScene traced(scene, ray_caster);
    PictureOptions options;
    options.samples = samples;
    options.seed = seed;
    options.quantity = PictureQuantity::irradiance;
    const std::vector<GaugeLight> found = hybrid_irradiance(traced, known, gauges, options, {});
    std::vector<double> exact;
    double mean = 0;
    for (const double irradiance : open) {
        exact.push_back(irradiance * (has_glass ? 0.5 : 1));
        mean += exact.back() / static_cast<double>(gauges.size());
    }
    std::vector<double> errors;
    for (std::size_t i = 0; i < gauges.size(); ++i)
        errors.push_back((static_cast<double>(found[i].irradiance().x) - exact[i]) / (mean > 0 ? mean : 1));
    return errors;
}

struct MeanAndError {
    double mean = 0, standard_error = 0, rms = 0;
};
MeanAndError statistics_of(const std::vector<double>& errors) {
    const auto n = static_cast<double>(errors.size());
    double sum = 0, squares = 0;
    for (const double e : errors) {
        sum += e;
        squares += e * e;
    }
    return {sum / n, std::sqrt((squares / n - sum * sum / (n * n)) / n), std::sqrt(squares / n)};
}

class SkyThroughAWindow : public testing::TestWithParam<KnownSky> {};
INSTANTIATE_TEST_SUITE_P(EverySky, SkyThroughAWindow, testing::ValuesIn(known_skies()),
                         testing::PrintToStringParamName());

// Five standard errors: one test in a million would fail by chance. Maps are integrated to about a percent.
TEST_P(SkyThroughAWindow, IsTheIntegralOverIt) {
    RELEASE_ONLY_IF(GetParam().name != "uniform" && GetParam().name != "map_of_eight");
    const std::vector<Gauge> gauges = texels_on_the_floor(1);
    const std::vector<double> open = exact_irradiance(GetParam(), gauges);
    for (const bool has_glass : {false, true}) {
        const MeanAndError found = statistics_of(errors_below(GetParam(), has_glass, 1, gauges, open));
        EXPECT_NEAR(found.mean, 0, 5 * found.standard_error + 2e-3) << has_glass;
        EXPECT_LT(found.standard_error, 0.02);  // else the test could not see an error
    }
}

// By chance, a share p of the directions finds the window, and their mean has a relative error of sqrt(1 / p /
// samples).
TEST(SkyThroughAWindow, HasTheNoiseOfFarMoreChanceDirections) {
    RELEASE_ONLY();  // see SkyThroughAWindow.IsTheIntegralOverIt
    KnownSky uniform{"uniform", {"sky", 0, UniformSky{Rgb(100)}}, [](const V3d&) { return 100.0; }, {}};
    double mean = 0;
    constexpr int places = 1000;
    for (std::uint64_t i = 0; i < places; ++i)
        mean += exact_irradiance(uniform, {4 * random_double(1, i) - 2, 4 * random_double(2, i) - 2, 0}) / places;
    const double by_chance = std::sqrt(pi * 100 / mean / samples);
    const std::vector<Gauge> gauges = texels_on_the_floor(2);
    const std::vector<double> open = exact_irradiance(uniform, gauges);
    EXPECT_LT(5 * statistics_of(errors_below(uniform, false, 2, gauges, open)).rms, by_chance);
}

// One path in four takes a direction. When it was always the first of four, the sky was 2.0, 1.33 and 1.2 times too
// bright.
TEST(UniformSky, IsUnbiasedForAnyNumberOfSamples) {
    Scene scene;
    add_rectangle(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, Rgb(0), Rgb(0)));
    scene.luminaires = {{"sky", 0, UniformSky{Rgb(100)}}};
    const RayCaster ray_caster(scene);
    const TracedScene traced(scene, ray_caster);
    std::vector<Gauge> gauges(20'000, {.normal = {0, 0, 1}, .patch = PatchIndex(0)});
    for (const int count : {2, 6, 10, 16}) {
        PictureOptions options;
        options.samples = count;
        options.quantity = PictureQuantity::irradiance;
        double sum = 0, squares = 0;
        for (const SampledIrradiance& light : direct_irradiance(traced, gauges, options, {})) {
            const double relative = static_cast<double>(light.irradiance.x) / (pi * 100) - 1;
            sum += relative;
            squares += relative * relative;
        }
        const auto n = static_cast<double>(gauges.size());
        EXPECT_NEAR(sum / n, 0, 5 * std::sqrt(squares / n / n) + 1e-5) << count;
        EXPECT_LT(std::sqrt(squares / n / n), 0.02) << count;
    }
}

}  // namespace
}  // namespace interflect
