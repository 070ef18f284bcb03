#include "interflect/image/tone/visual_adaptation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "interflect/image.h"

namespace interflect {

using namespace detail;
namespace {

/// Returns the display value of a uniform grey of this luminance [cd/m^2], with 1 for white.
double shown(float luminance, Tonemap curve, float white = 100) {
    return tone_map(Image(4, 4, Rgb(luminance)), 0, curve, white).at(1, 1).y;
}

/// ((1.219 + 50^0.4) / (1.219 + L^0.4))^2.5 / 100, computed by hand: 50^0.4 = 4.7818, 100^0.4 = 6.3096, 1000^0.4 =
/// 15.8489.
TEST(Ward, ScaleFactorsOfThePaper) {
    EXPECT_NEAR(ward_factor(1, 100), std::pow(6.0008 / 2.219, 2.5) / 100, 1e-5);
    EXPECT_NEAR(ward_factor(100, 100), std::pow(6.0008 / 7.5286, 2.5) / 100, 1e-6);
    EXPECT_NEAR(ward_factor(1000, 100), std::pow(6.0008 / 17.0679, 2.5) / 100, 1e-7);
    EXPECT_NEAR(ward_factor(50, 100), 0.01, 1e-6) << "a scene as bright as the display is shown as it is";
    EXPECT_NEAR(ward_factor(1, 400) * 400, std::pow((1.219 + std::pow(200, 0.4)) / 2.219, 2.5), 1e-4);
}

TEST(Ward, PicturesAreMultipliedByTheFactorOfTheirLogarithmicMean) {
    Image image(10, 10, Rgb(10));
    for (int i = 0; i < 50; ++i) image.pixels[static_cast<std::size_t>(i)] = Rgb(1000);
    const Image mapped = tone_map(image, 0, Tonemap::ward);
    EXPECT_NEAR(mapped.pixels[99].x, 10 * std::pow(6.0008 / 7.5286, 2.5) / 100, 1e-5);
}

/// gamma(1) = 1.855, gamma(10) = 2.255 and gamma(100) = 2.655, without the 2.3e-5 in the logarithm. A display of 100
/// cd/m^2 with a contrast of 100 has its middle at 10.
TEST(Tumblin, EquationsOfThePaper) {
    const auto expected = [](double gamma) { return 0.1 * std::pow(10, gamma / 2.255 - 1); };
    EXPECT_NEAR(shown(1, Tonemap::tumblin), expected(1.855), 1e-5);
    EXPECT_NEAR(shown(10, Tonemap::tumblin), 0.1, 1e-6);
    EXPECT_NEAR(shown(100, Tonemap::tumblin), expected(2.655), 1e-5);
    EXPECT_NEAR(shown(5000, Tonemap::tumblin), expected(2.655), 1e-5) << "gamma is constant from 100 cd/m^2";
    const double ratio = 2.655 / 2.255;
    EXPECT_NEAR(TumblinOperator(100, 100)(200) / TumblinOperator(100, 100)(100), std::pow(2, ratio), 1e-5);
    EXPECT_EQ(TumblinOperator(100, 100)(0), 0);
}

/// In the straight parts of the paper's fits log t is -0.72 and log L - 1.255, -2.86 and log L - 0.395.
TEST(Ferwerda, ThresholdsOfThePaper) {
    EXPECT_NEAR(cone_threshold(1e-4f), std::pow(10, -0.72), 1e-5);
    EXPECT_NEAR(cone_threshold(1000), 1000 * std::pow(10, -1.255), 1e-3);
    EXPECT_NEAR(cone_threshold(1), std::pow(10, std::pow(0.65, 2.7) - 0.72), 1e-5);
    EXPECT_NEAR(rod_threshold(1e-5f), std::pow(10, -2.86), 1e-7);
    EXPECT_NEAR(rod_threshold(1), std::pow(10, -0.395), 1e-5);
    EXPECT_NEAR(rod_threshold(0.01f), std::pow(10, std::pow(1.6 - 0.81, 2.18) - 2.86), 1e-6);
    for (const float bound : {std::pow(10.0f, -2.6f), std::pow(10.0f, 1.9f)})
        EXPECT_NEAR(cone_threshold(bound * 0.999f) / cone_threshold(bound * 1.001f), 1, 0.05) << bound;
    for (const float bound : {std::pow(10.0f, -3.94f), std::pow(10.0f, -1.44f)})
        EXPECT_NEAR(rod_threshold(bound * 0.999f) / rod_threshold(bound * 1.001f), 1, 0.05) << bound;
}

TEST(Ferwerda, BrightScenesAreSeenByConesAlone) {
    const double display = std::pow(10, std::pow(0.249 * std::log10(50) + 0.65, 2.7) - 0.72);
    EXPECT_NEAR(shown(1000, Tonemap::ferwerda), 1000 * display / (1000 * std::pow(10, -1.255)) / 100, 1e-4);
    EXPECT_NEAR(shown(50, Tonemap::ferwerda), 0.5, 1e-5) << "adapted as the observer before the display";
    const Rgb colour = tone_map(Image(2, 2, Rgb(400, 200, 100)), -1, Tonemap::ferwerda).at(0, 0);
    EXPECT_NEAR(colour.x / colour.y, 2, 1e-5);
}

/// At 0.001 cd/m^2 the scotopic luminance is 2.573 times that [scotopic cd/m^2], and all of it is added.
TEST(Ferwerda, InTheDarkColoursAreGrey) {
    const double display = std::pow(10, std::pow(0.249 * std::log10(50) + 0.65, 2.7) - 0.72);
    const double rods = std::pow(10, std::pow(0.405 * std::log10(0.002573) + 1.6, 2.18) - 2.86);
    const double cones = std::pow(10, -0.72);
    EXPECT_NEAR(shown(0.001f, Tonemap::ferwerda), 0.01 * display * (0.001 / cones + 0.002573 / rods), 1e-5);
    const Rgb colour = tone_map(Image(2, 2, Rgb(4e-3f, 2e-3f, 1e-3f)), 0, Tonemap::ferwerda).at(0, 0);
    EXPECT_GT(colour.x, colour.y);
    EXPECT_LT(colour.x / colour.y, 1.05);
}

/// At intermediate luminance a part of the rods' signal is added: at 10 cd/m^2 (1 - 4.99 / 9.99)^2 of it.
TEST(Ferwerda, BothAtDusk) {
    const double display = std::pow(10, std::pow(0.249 * std::log10(50) + 0.65, 2.7) - 0.72);
    const double rods = std::pow(10, -0.395), cones = std::pow(10, std::pow(0.249 + 0.65, 2.7) - 0.72);
    EXPECT_NEAR(shown(10, Tonemap::ferwerda), 0.01 * display * (10 / cones + 0.25050 / rods), 1e-5);
}

/// Larson et al. 1997 for white, X, Y, Z = 0.9505, 1, 1.089; and for green, to which rods are far more sensitive than
/// to red.
TEST(Ferwerda, ScotopicLuminance) {
    EXPECT_NEAR(scotopic_luminance(Rgb(1)), 1.33 * (1 + 2.089 / 0.9505) - 1.68, 0.002);
    EXPECT_NEAR(scotopic_luminance(Rgb(0, 1, 0)), 0.7152 * (1.33 * (1 + (0.7152 + 0.1192) / 0.3576) - 1.68), 0.001);
    EXPECT_GT(scotopic_luminance(Rgb(0, 1, 0)), 20 * scotopic_luminance(Rgb(1, 0, 0)));
}

TEST(AbsoluteOperators, BrighterScenesLookBrighter) {
    for (const Tonemap curve : {Tonemap::ward, Tonemap::ferwerda}) {
        EXPECT_LT(shown(0.1f, curve), shown(10, curve));
        EXPECT_LT(shown(10, curve), shown(1000, curve));
    }
    EXPECT_LT(shown(0.1f, Tonemap::tumblin), shown(10, Tonemap::tumblin));
    EXPECT_LT(shown(10, Tonemap::tumblin), shown(1000, Tonemap::tumblin));
}

}  // namespace
}  // namespace interflect
