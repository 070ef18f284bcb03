#include "interflect/tone_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "interflect/error.h"
#include "interflect/image/srgb.h"

namespace interflect {
namespace {

Rgb grey(float v) { return Rgb(v, v, v); }
Image one_pixel(const Rgb& colour) { return Image(1, 1, colour); }
Rgb mapped(const Rgb& colour, float exposure, Tonemap curve) {
    return tone_map(one_pixel(colour), exposure, curve).at(0, 0);
}

class Curves : public testing::TestWithParam<Tonemap> {};
INSTANTIATE_TEST_SUITE_P(All, Curves, testing::Values(Tonemap::linear, Tonemap::reinhard, Tonemap::filmic));

TEST_P(Curves, RiseFromBlackToWhite) {
    float last = 0;
    for (float v = 1e-4f; v < 1e4f; v *= 1.1f) {
        const Rgb shown = mapped(grey(v), 0, GetParam());
        EXPECT_EQ(shown.x, shown.y);
        EXPECT_TRUE(v < 0.9f ? shown.x > last : shown.x >= last) << v;
        EXPECT_LE(shown.x, 1) << v;
        last = shown.x;
    }
    EXPECT_EQ(last, 1);
}

TEST_P(Curves, BlackStaysBlack) {
    EXPECT_EQ(mapped(grey(0), 5, GetParam()), grey(0));
    EXPECT_EQ(mapped(grey(-1), 0, GetParam()), grey(0));
}

TEST_P(Curves, ShadowsAndMidGreyKeepTheirTones) {
    EXPECT_NEAR(mapped(grey(0.01f), 0, GetParam()).x, 0.01, 0.003);
    EXPECT_NEAR(mapped(grey(0.18f), 0, GetParam()).x, 0.18, 0.03);
}

TEST_P(Curves, ExposureIsInStops) {
    const Rgb colour(0.1f, 0.05f, 0.02f);
    EXPECT_EQ(mapped(colour, 3, GetParam()), mapped(colour * 8, 0, GetParam()));
    EXPECT_EQ(mapped(colour, -1, GetParam()), mapped(colour / 2, 0, GetParam()));
}

TEST_P(Curves, DoNotHideWhatIsNotFinite) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(is_finite(mapped(Rgb(nan, 0, 0), 0, GetParam())));
    EXPECT_FALSE(is_finite(mapped(Rgb(0, infinity, 0), 0, GetParam())));
}

TEST(ToneMap, WhiteIsWhereTheHeaderSaysItIs) {
    EXPECT_NEAR(mapped(grey(4), 0, Tonemap::reinhard).x, 1, 1e-5);
    EXPECT_LT(mapped(grey(3.6f), 0, Tonemap::reinhard).x, 1);
    EXPECT_NEAR(mapped(grey(6.4f), 0, Tonemap::filmic).x, 1, 1e-3);
    EXPECT_LT(mapped(grey(6), 0, Tonemap::filmic).x, 0.999f);
    EXPECT_NEAR(mapped(grey(0.18f), 0, Tonemap::filmic).x, 0.18, 1e-3);
}

TEST(ToneMap, ReinhardKeepsHues) {
    const Rgb shown = mapped(Rgb(0.8f, 0.4f, 0.2f), 0, Tonemap::reinhard);
    EXPECT_FLOAT_EQ(shown.x / shown.y, 2);
    EXPECT_FLOAT_EQ(shown.y / shown.z, 2);
}

TEST(AutomaticExposure, BringsTheLogarithmicMeanToTheKey) {
    Image image(10, 10, grey(50));
    for (int i = 0; i < 50; ++i) image.pixels[i] = grey(200);
    EXPECT_NEAR(std::exp2(automatic_exposure(image)) * 100, 0.28, 1e-5) << "the geometric mean of 50 and 200 is 100";
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
