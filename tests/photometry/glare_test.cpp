// Unified Glare Rating against published position indices and sources of known luminance and solid angle.

#include "interflect/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <tuple>
#include <vector>

#include "interflect/core.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

using std::numbers::pi;

/// CIE 117:1995, table of position indices, T/R = 0: straight above the line of sight, by H/R (height over distance).
class PositionIndex : public testing::TestWithParam<std::tuple<float, double>> {};
TEST_P(PositionIndex, IsThatOfTheTable) {
    const auto [height, p] = GetParam();
    EXPECT_NEAR(position_index({1, 0, height}, {1, 0, 0}), p, 0.035 * p);
    EXPECT_NEAR(position_index({0, -3, 3 * height}, {0, -2, 0}), p, 0.035 * p);
    EXPECT_NEAR(position_index({1, 0, -height}, {1, 0, 0}), p, 0.035 * p);
}
INSTANTIATE_TEST_SUITE_P(Cie117, PositionIndex,
                         testing::Values(std::tuple(0.0f, 1.0), std::tuple(0.1f, 1.26), std::tuple(0.2f, 1.53),
                                         std::tuple(0.3f, 1.90), std::tuple(0.5f, 2.86), std::tuple(0.7f, 4.20),
                                         std::tuple(1.0f, 7.00), std::tuple(1.3f, 10.35), std::tuple(1.7f, 16.20)),
                         printed_name);

/// sigma = 45 degrees, tau = 90: ln p = (35.2 - 28.7001 - 1.22 e^-20) 0.045 + (21 + 24.0003 - 24.0003) 0.02025.
TEST(PositionIndex, IsSmallerToTheSide) {
    EXPECT_NEAR(position_index({1, 1, 0}, {1, 0, 0}), std::exp(0.2925 + 0.42525), 1e-3);
    EXPECT_EQ(position_index({1, -1, 0}, {1, 0, 0}), position_index({1, 1, 0}, {1, 0, 0}));
    EXPECT_TRUE(std::isinf(position_index({-1, 0, 1}, {1, 0, 0})));
}

/// The table ends at H/R = 1.9 and at T/R = 3, on both sides of the line of sight.
TEST(PositionIndex, IsTabulatedAheadOfTheObserver) {
    for (const float sign : {1.0f, -1.0f}) {
        EXPECT_TRUE(has_position_index({1, 0, 1.89f * sign}, {1, 0, 0}));
        EXPECT_FALSE(has_position_index({1, 0, 1.91f * sign}, {1, 0, 0}));
        EXPECT_TRUE(has_position_index({1, 2.99f * sign, 1}, {2, 0, 0}));
        EXPECT_FALSE(has_position_index({1, 3.01f * sign, 1}, {2, 0, 0}));
    }
    EXPECT_FALSE(has_position_index({-1, 0, 0}, {1, 0, 0}));
    EXPECT_FALSE(has_position_index({0, 0, 1}, {1, 0, 0}));
    // The line of sight falls by 45 degrees: a lamp straight ahead is as high above it as it is far along it.
    EXPECT_TRUE(has_position_index({1, 0, 0}, {1, 0, -1}));
    EXPECT_FALSE(has_position_index({1, 0, 0.5f}, {1, 0, -1}));
}

/// 8 log10(0.25 / 40 (6000^2 0.01 / 2^2 + 3000^2 0.02 / 1.5^2)) = 8 log10(1062.5), worked out by hand.
TEST(UnifiedGlareRating, IsThatOfTheFormula) {
    const std::vector<GlareSource> sources{{"a", 6000, 0.01, 2, 90'000}, {"b", 3000, 0.02, 1.5, 80'000}};
    EXPECT_NEAR(unified_glare_rating(40, sources), 24.211, 1e-3);
    std::vector<GlareSource> with_unrated = sources;
    with_unrated.push_back({"c", 9000, 0.02, 1.5, 720'000, false});
    EXPECT_EQ(unified_glare_rating(40, with_unrated), unified_glare_rating(40, sources));
    EXPECT_EQ(unified_glare_rating(40, {}), -std::numeric_limits<double>::infinity());
}

Scene room(float rho = 0.5f) {
    Scene scene = closed_box({6, 4, 3}, 1, {Material{"paint", Rgb(rho), Rgb(0)}});
    scene.objects = {"", "lamp"};
    return scene;
}
const Observer observer{{1, 2, 1.2}, {2, 0, 0}};

/// A disk of 0.1 m diameter that emits 300 cd cos(theta): its luminance is 300 / A in all directions.
Luminaire disk(const V3f& position, const V3f& faces) {
    auto web = std::make_shared<PhotometricWeb>();
    for (int i = 0; i <= 90; ++i) web->polar.push_back(static_cast<float>(i));
    web->azimuth = {0, 360};
    for (int repeat = 0; repeat < 2; ++repeat)
        for (int i = 0; i <= 90; ++i)
            web->intensities.push_back(i < 90 ? 300 * std::cos(static_cast<float>(i * pi / 180)) : 0);
    web->opening = {LuminousOpening::Shape::cylinder, {0.1f, 0.1f, 0}, 2};
    return {"disk", 1, MeasuredLight{web, position, faces}};
}

void expect_source(const GlareSource& source, double luminance, double solid_angle, double p) {
    EXPECT_NEAR(source.luminance, luminance, 2e-3 * luminance);
    EXPECT_NEAR(source.solid_angle, solid_angle, 2e-3 * solid_angle);
    EXPECT_NEAR(source.position_index, p, 2e-3 * p);
    EXPECT_NEAR(source.glare, luminance * luminance * solid_angle / (p * p), 4e-3 * source.glare);
}

/// 3 m ahead and 1.5 m above the observer, facing down: A = 0.00785 m^2, cos = 1.5 / r, omega = A cos / r^2.
TEST(GlareSources, OfOneSmallDiskAreAsComputed) {
    Scene scene = room();
    scene.luminaires.push_back(disk({4, 2, 2.7f}, {0, 0, -1}));
    const double area = pi * 0.0025, r2 = 9 + 2.25, omega = area * 1.5 / std::pow(r2, 1.5);
    const double sigma = std::atan(0.5) * 180 / pi, p = std::exp(33.98e-3 * sigma + 21e-5 * sigma * sigma);
    const auto sources = glare_sources(scene, RayCaster(scene), observer);
    ASSERT_EQ(sources.size(), 1u);
    EXPECT_EQ(sources[0].name, "disk");
    expect_source(sources[0], 300 / area, omega, p);
    // Not visible from behind, or from above its plane.
    EXPECT_TRUE(glare_sources(scene, RayCaster(scene), {{1, 2, 1.2}, {-1, 0, 0}}).empty());
    EXPECT_TRUE(glare_sources(scene, RayCaster(scene), {{1, 2, 2.9}, {1, 0, 0}}).empty());
}

/// The same as a patch of 0.1 x 0.1 m, of object 'lamp': L = M / pi. Divided into many patches it remains one source.
TEST(GlareSources, OfPatchesAreGroupedByObject) {
    for (const int divisions : {1, 4}) {
        Scene scene = room();
        const std::uint32_t material = add_material(scene, Rgb(0.2f), Rgb(3e4f));
        const std::uint32_t first =
            add_rectangle(scene, {3.95f, 1.95f, 2.7f}, {0, 0.1f, 0}, {0.1f, 0, 0}, material, divisions, divisions);
        for (std::uint32_t i = first; i < scene.patches.size(); ++i) scene.patches[i].object = 1;
        const double omega = 0.01 * 1.5 / std::pow(9 + 2.25, 1.5);
        const auto sources = glare_sources(scene, RayCaster(scene), observer);
        ASSERT_EQ(sources.size(), 1u);
        EXPECT_EQ(sources[0].name, "lamp");
        expect_source(sources[0], 3e4 / pi, omega, position_index({3, 0, 1.5f}, {1, 0, 0}));
    }
}

/// A luminaire is rated by its centre alone: one disk of 0.8 m at H/R = 1.85, one at 1.95, both 1.5 m above the eye.
TEST(GlareSources, OfLuminairesOutsideOfTheTableAreNotRated) {
    for (const float ratio : {1.85f, 1.95f}) {
        Scene scene = room();
        Luminaire wide = disk({1 + 1.5f / ratio, 2, 2.7f}, {0, 0, -1});
        auto web = std::make_shared<PhotometricWeb>(*std::get<MeasuredLight>(wide.kind).web);
        web->opening.size = {0.8f, 0.8f, 0};
        std::get<MeasuredLight>(wide.kind).web = web;
        scene.luminaires = {disk({4, 2, 2.7f}, {0, 0, -1}), wide};
        scene.luminaires[1].name = "wide";
        const auto sources = glare_sources(scene, RayCaster(scene), observer);
        ASSERT_EQ(sources.size(), 2u);
        const GlareSource& of_wide = sources[0].name == "wide" ? sources[0] : sources[1];
        EXPECT_EQ(of_wide.is_rated, ratio < 1.9f);
        EXPECT_GT(of_wide.glare, 0);
        EXPECT_TRUE(sources[0].is_rated);
    }
}

/// CIE 117 knows one direction per luminaire. The integral of L^2 / p^2 over this opening of 1.2 m x 1.2 m, 0.4 m above
/// the eye, is smaller by a quarter. Seen to fail with p and omega of each sample.
TEST(GlareSources, OfWideLuminairesAreThoseOfTheirCentres) {
    Scene scene = room();
    Luminaire wide = disk({2, 2.3f, 1.6f}, {0, 0, -1});
    auto web = std::make_shared<PhotometricWeb>(*std::get<MeasuredLight>(wide.kind).web);
    web->opening = {LuminousOpening::Shape::box, {1.2f, 1.2f, 0}, 2};
    std::get<MeasuredLight>(wide.kind).web = web;
    scene.luminaires = {wide};
    const double r2 = 1 + 0.09 + 0.16, cosine = 0.4 / std::sqrt(r2);
    const auto sources = glare_sources(scene, RayCaster(scene), observer);
    ASSERT_EQ(sources.size(), 1u);
    expect_source(sources[0], 300 / 1.44, 1.44 * cosine / r2, position_index({1, 0.3f, 0.4f}, {1, 0, 0}));
}

/// A panel from H/R = 1.5 / 0.6 = 2.5 to 1.5 / 1.2 = 1.25 is rated from 1.5 / 1.9 = 0.789 m on: 0.411 / 0.6 of its
/// area. L = M / pi and omega = integral of 1.5 / r^3 over the part, by the midpoint rule.
TEST(GlareSources, OfPatchesAreRatedByTheirCells) {
    Scene scene = room();
    const std::uint32_t material = add_material(scene, Rgb(0.2f), Rgb(3e4f));
    add_rectangle(scene, {1.6f, 1.9f, 2.7f}, {0, 0.2f, 0}, {0.6f, 0, 0}, material);
    scene.patches.back().object = 1;
    double rated = 0, others = 0;
    constexpr int steps = 600;
    for (int i = 0; i < steps; ++i) {
        const double x = 0.6 + 0.6 * (i + 0.5) / steps, omega = 0.2 * 0.6 / steps * 1.5 / std::pow(x * x + 2.25, 1.5);
        (x > 1.5 / 1.9 ? rated : others) += omega;
    }
    const auto sources = glare_sources(scene, RayCaster(scene), observer);
    ASSERT_EQ(sources.size(), 2u);
    EXPECT_TRUE(sources[0].is_rated);
    EXPECT_FALSE(sources[1].is_rated);
    for (const GlareSource& source : sources) {
        EXPECT_EQ(source.name, "lamp");
        EXPECT_NEAR(source.luminance, 3e4 / pi, 1);
    }
    EXPECT_NEAR(sources[0].solid_angle, rated, 0.06 * rated);  // the width of a cell
    EXPECT_NEAR(sources[1].solid_angle, others, 0.1 * others);
}

/// A screen hides the upper half of a panel that stands straight ahead; glass transmits a part of its light.
TEST(GlareSources, AreSeenAsFarAsNothingHidesThem) {
    for (const float transmittance : {0.0f, 0.6f}) {
        Scene scene = room();
        const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(3e4f));
        add_rectangle(scene, {5, 1.9f, 1.1f}, {0, 0, 0.2f}, {0, 0.2f, 0}, lamp);
        const double whole = glare_sources(scene, RayCaster(scene), observer).at(0).solid_angle;
        const std::uint32_t screen = add_material(scene, Rgb(0), Rgb(0));
        scene.materials[screen].transmittance = Rgb(transmittance);
        add_rectangle(scene, {3, 1, 1.2f}, {0, 2, 0}, {0, 0, 1}, screen, 1, 1, true);
        const GlareSource source = glare_sources(scene, RayCaster(scene), observer).at(0);
        if (transmittance == 0) {
            EXPECT_NEAR(source.solid_angle, whole / 2, 1e-3 * whole);
            EXPECT_NEAR(source.luminance, 3e4 / pi, 1);
        } else {
            EXPECT_NEAR(source.solid_angle, whole, 1e-3 * whole);
            EXPECT_NEAR(source.luminance, 0.8 * 3e4 / pi, 1);
        }
    }
}

/// Lb is the indirect illuminance at the observer over pi, and the rating follows from the formula.
TEST(RateGlare, PutsSourcesBeforeTheirBackground) {
    Scene scene = room();
    scene.luminaires.push_back(disk({4, 2, 2.7f}, {0, 0, -1}));
    const RayCaster ray_caster(scene);
    const MeasuringOptions options{.shading = Shading::path, .samples = 8192};
    const GlareRating rating = rate_glare(scene, nullptr, ray_caster, std::vector{observer}, options).at(0);
    const MeasuredIrradiance at_eye =
        measure_irradiance(scene, nullptr, ray_caster, std::vector<MeasuringPoint>{{{1, 2, 1.2}, {1, 0, 0}}}, options)
            .at(0);
    EXPECT_NEAR(rating.background_luminance, static_cast<double>(at_eye.indirect.x) / pi, 1e-4);
    EXPECT_GT(at_eye.direct.x, 0);
    ASSERT_EQ(rating.sources.size(), 1u);
    EXPECT_NEAR(rating.ugr, 8 * std::log10(0.25 / rating.background_luminance * rating.sources[0].glare), 1e-9);
    EXPECT_GT(rating.standard_error, 0);
    EXPECT_LT(rating.standard_error, 0.1);
    const GlareRating unlit = rate_glare(room(), nullptr, RayCaster(room()), std::vector{observer}, options).at(0);
    EXPECT_TRUE(std::isinf(unlit.ugr));
}

TEST(RateGlare, RefusesWhatHasNoDirection) {
    const Scene scene = room();
    EXPECT_THROW(rate_glare(scene, nullptr, RayCaster(scene), std::vector<Observer>{{{1, 1, 1}, {0, 0, 0}}},
                            {.shading = Shading::path}),
                 InputError);
}

}  // namespace
}  // namespace interflect
