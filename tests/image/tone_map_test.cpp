#include "interflect/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "interflect/core.h"
#include "interflect/image/codecs/srgb.h"
#include "tests/support/parameter_names.h"

namespace interflect {

using namespace detail;
namespace {

Rgb grey(float v) { return Rgb(v, v, v); }
Image one_pixel(const Rgb& colour) { return Image(1, 1, colour); }
Rgb mapped(const Rgb& colour, float exposure, Tonemap curve) {
    return tone_map(one_pixel(colour), exposure, curve).at(0, 0);
}

/// Greys from 10^-3 to 10^4.5, each 1% brighter than the last.
Image ramp() {
    constexpr int steps = 1736;
    Image image(steps, 1);
    for (int i = 0; i < steps; ++i) image.at(i, 0) = grey(1e-3f * std::pow(1.01f, static_cast<float>(i)));
    return image;
}

class Operators : public testing::TestWithParam<Tonemap> {};
INSTANTIATE_TEST_SUITE_P(All, Operators,
                         testing::Values(Tonemap::srgb, Tonemap::reinhard, Tonemap::filmic, Tonemap::agx, Tonemap::ward,
                                         Tonemap::tumblin, Tonemap::ferwerda),
                         testing_support::printed_name);

TEST_P(Operators, RiseFromBlackToWhite) {
    const Image shown = tone_map(ramp(), 0, GetParam());
    float last = 0;
    for (const Rgb& pixel : shown.pixels) {
        EXPECT_NEAR(pixel.x, pixel.y, 1e-5);
        EXPECT_NEAR(pixel.x, pixel.z, 1e-5);
        EXPECT_TRUE(last < 0.9f ? pixel.x > last : pixel.x >= last) << last;
        EXPECT_LE(pixel.x, 1);
        last = pixel.x;
    }
    EXPECT_NEAR(last, 1, 1e-5);
    EXPECT_LT(shown.pixels.front().x, 0.01);
}

TEST_P(Operators, BlackStaysBlack) {
    Image image(2, 1, grey(100));
    for (const float dark : {0.0f, -1.0f}) {
        image.at(1, 0) = grey(dark);
        EXPECT_EQ(tone_map(image, 5, GetParam()).at(1, 0), grey(0));
        EXPECT_EQ(mapped(grey(dark), 5, GetParam()), grey(0)) << "a picture without light";
    }
}

TEST_P(Operators, DoNotHideWhatIsNotFinite) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(is_finite(mapped(Rgb(nan, 0, 0), 0, GetParam())));
    EXPECT_FALSE(is_finite(mapped(Rgb(0, infinity, 0), 0, GetParam())));
}

class Curves : public testing::TestWithParam<Tonemap> {};
INSTANTIATE_TEST_SUITE_P(All, Curves, testing::Values(Tonemap::srgb, Tonemap::reinhard, Tonemap::filmic, Tonemap::agx),
                         testing_support::printed_name);

TEST_P(Curves, KeepMidGrey) { EXPECT_NEAR(mapped(grey(0.18f), 0, GetParam()).x, 0.18, 0.04); }

TEST_P(Curves, WhatOverflowsIsWhite) {
    const Rgb shown = mapped(grey(std::numeric_limits<float>::max()), 90, GetParam());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], 1, 1e-5);
}

TEST_P(Curves, ExposureIsInStops) {
    const Rgb colour(0.1f, 0.05f, 0.02f);
    EXPECT_EQ(mapped(colour, 3, GetParam()), mapped(colour * 8, 0, GetParam()));
    EXPECT_EQ(mapped(colour, -1, GetParam()), mapped(colour / 2, 0, GetParam()));
}

TEST(ToneMap, SrgbIsTheDefaultAndClips) {
    const Rgb colour(0.1f, 0.5f, 3);
    EXPECT_EQ(tone_map(one_pixel(colour), 0).at(0, 0), Rgb(0.1f, 0.5f, 1));
    EXPECT_EQ(mapped(colour, 0, Tonemap::srgb), Rgb(0.1f, 0.5f, 1));
}

TEST(ToneMap, WhiteIsWhereTheHeaderSaysItIs) {
    const float agx_white = 0.18f * std::exp2(6.5f);
    for (const auto& [curve, white] : {std::pair(Tonemap::srgb, 1.0f), std::pair(Tonemap::reinhard, 4.0f),
                                       std::pair(Tonemap::filmic, 10.0f), std::pair(Tonemap::agx, agx_white)}) {
        EXPECT_NEAR(mapped(grey(white), 0, curve).x, 1, 2e-4);
        EXPECT_LT(mapped(grey(0.9f * white), 0, curve).x, 0.9999f);
    }
    EXPECT_NEAR(mapped(grey(0.18f), 0, Tonemap::filmic).x, 0.18, 1e-5);
    EXPECT_NEAR(mapped(grey(0.18f), 0, Tonemap::agx).x, std::pow(0.5, 2.2), 1e-4);
}

/// Narkowicz's curve at an input of 1, with the fraction (2.51 + 0.03) / (2.43 + 0.59 + 0.14).
TEST(ToneMap, FilmicIsNarkowiczsFit) {
    EXPECT_NEAR(mapped(grey(1 / 0.72317f), 0, Tonemap::filmic).x, 2.54 / 3.16, 1e-5);
}

/// The polynomial that Wrensch fitted to AgX's curve; the error of the fit is 0.006.
TEST(ToneMap, AgxHasTheCurveOfItsFit) {
    for (double x = 0.02; x < 1; x += 0.02) {
        const double fit = ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x) + 0.1191) * x - 0.00232;
        const auto v = static_cast<float>(0.18 * std::exp2(16.5 * x - 10));
        EXPECT_NEAR(std::pow(mapped(grey(v), 0, Tonemap::agx).x, 1 / 2.2), fit, 0.007) << x;
    }
}

TEST(ToneMap, AgxPalesBrightColours) {
    const Rgb dim = mapped(Rgb(0.2f, 0.02f, 0.02f), 0, Tonemap::agx),
              bright = mapped(Rgb(8, 0.8f, 0.8f), 0, Tonemap::agx);
    EXPECT_GT(dim.x / dim.y, 4);
    EXPECT_LT(bright.x / bright.y, 3);
    EXPECT_NEAR(bright.y, bright.z, 1e-3);
}

TEST(ToneMap, HuesStayWhereTheHeaderSaysSo) {
    for (const Tonemap curve : {Tonemap::srgb, Tonemap::reinhard, Tonemap::ward, Tonemap::tumblin}) {
        const Rgb shown = mapped(Rgb(0.8f, 0.4f, 0.2f), 0, curve);
        EXPECT_FLOAT_EQ(shown.x / shown.y, 2);
        EXPECT_FLOAT_EQ(shown.y / shown.z, 2);
    }
}

TEST(ToneMap, ExposureMultipliesWhatAbsoluteOperatorsShow) {
    for (const Tonemap curve : {Tonemap::ward, Tonemap::tumblin, Tonemap::ferwerda}) {
        const Rgb shown = mapped(grey(50), 0, curve), darker = mapped(grey(50), -2, curve);
        EXPECT_FLOAT_EQ(darker.x, shown.x / 4);
    }
}

TEST(ToneMap, RefusesADisplayWithoutLight) {
    for (const float white : {0.0f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity()})
        EXPECT_THROW(tone_map(Image(1, 1), 0, Tonemap::ward, white), InputError);
}

TEST(AutomaticExposure, BringsTheLogarithmicMeanToTheKey) {
    Image image(10, 10, grey(50));
    for (int i = 0; i < 50; ++i) image.pixels[i] = grey(200);
    EXPECT_NEAR(std::exp2(automatic_exposure(image)) * 100, 0.2, 1e-5) << "the geometric mean of 50 and 200 is 100";
}

TEST(AutomaticExposure, LampsAndDarkCornersDoNotDecide) {
    Image image(100, 100, grey(100));
    const float without = automatic_exposure(image);
    for (int i = 0; i < 5000; ++i) image.pixels[i] = grey(0);         // half is black
    for (int i = 5000; i < 5200; ++i) image.pixels[i] = grey(1e6f);   // 4% of the rest are lamps
    for (int i = 5200; i < 5400; ++i) image.pixels[i] = grey(1e-6f);  // 4% are nearly black
    EXPECT_NEAR(automatic_exposure(image), without, 0.01);
}

TEST(ToneMap, RefusesAnExposureThatIsNoNumber) {
    for (const float exposure : {std::nanf(""), std::numeric_limits<float>::infinity()})
        EXPECT_THROW(tone_map(Image(1, 1), exposure), InputError);
}

TEST(AutomaticExposure, OfNothingIsZero) {
    EXPECT_EQ(automatic_exposure(Image(3, 2)), 0);
    EXPECT_EQ(automatic_exposure(Image()), 0);
    EXPECT_EQ(automatic_exposure(one_pixel(grey(std::numeric_limits<float>::quiet_NaN()))), 0);
    EXPECT_EQ(tone_map(Image(3, 2), automatic_exposure(Image(3, 2))).pixels, Image(3, 2).pixels);
}

TEST(Srgb, MeetsTheStandard) {
    EXPECT_EQ(srgb_byte(0), 0);
    EXPECT_EQ(srgb_byte(1), 255);
    EXPECT_EQ(srgb_byte(0.18f), 118);
    EXPECT_EQ(srgb_byte(0.002f), 7);  // the linear part: 255 x 12.92 x 0.002 = 6.6
    EXPECT_EQ(srgb_byte(-1), 0);
    EXPECT_EQ(srgb_byte(7), 255);
    for (int byte = 0; byte < 256; ++byte) EXPECT_EQ(srgb_byte(srgb_decode(static_cast<float>(byte) / 255)), byte);
}

}  // namespace
}  // namespace interflect
