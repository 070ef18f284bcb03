#include "interflect/formats/build/colour.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace interflect {

using namespace detail;
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

void expect_near(const Rgb& a, const Rgb& b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(MgfColour, NeutralIsExactlyGrey) {
    const Rec709Colour grey = to_rec709(Chromaticity{}, 0.9, 0.99);
    EXPECT_EQ(grey.rgb, Rgb(0.9f, 0.9f, 0.9f));
    EXPECT_FALSE(grey.out_of_gamut || grey.too_bright);
}

TEST(MgfColour, D65IsBluerThanNeutral) {
    // Adapted from E to D65, the chromaticity of D65 itself is as blue to a D65 white as D65 is to E.
    const Rgb blue = to_rec709({0.3127, 0.3290}, 1, unbounded).rgb;
    EXPECT_LT(blue.x, 1);
    EXPECT_GT(blue.z, 1.05);
}

TEST(MgfColour, AdaptationIsBradfords) {
    // Lindbloom's published matrix from E to D65, then his sRGB matrix, by hand for x = 0.4, y = 0.4: XYZ = (1, 1,
    // 0.5); adapted (0.93853, 0.99530, 0.54420); RGB = (1.24006, 0.98011, 0.42450), divided by its luminance 0.99526.
    expect_near(to_rec709({0.4, 0.4}, 1, unbounded).rgb, Rgb(1.2460f, 0.9848f, 0.4265f), 2e-4f);
}

TEST(MgfColour, LuminanceIsKeptForEveryChromaticity) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 10'000; ++i) {
        double x = uniform(random), y = uniform(random);
        if (x + y > 1) {
            x = 1 - x;
            y = 1 - y;
        }
        if (y < 1e-6) continue;
        const double rd = uniform(random);
        const Rec709Colour reflectance = to_rec709({x, y}, rd, 0.99);
        EXPECT_NEAR(luminance(reflectance.rgb), std::min(rd, 0.99), 1e-5) << x << " " << y << " " << rd;
        EXPECT_GE(std::min({reflectance.rgb.x, reflectance.rgb.y, reflectance.rgb.z}), 0);
        EXPECT_LE(largest_channel(reflectance.rgb), 0.99f);
        EXPECT_NEAR(luminance(to_rec709({x, y}, 1000, unbounded).rgb), 1000, 1e-2);
    }
}

TEST(MgfColour, OutOfGamutLosesSaturationNotHue) {
    const Rec709Colour green = to_rec709({0.0, 0.5}, 0.2, 0.99);
    EXPECT_TRUE(green.out_of_gamut);
    EXPECT_FALSE(green.too_bright);
    EXPECT_EQ(green.rgb.x, 0);
    EXPECT_GT(green.rgb.y, green.rgb.z);
}

TEST(MgfColour, BrightSaturatedColourIsDesaturatedToTheBound) {
    const Rec709Colour red = to_rec709({0.6, 0.33}, 0.4, 0.99);
    EXPECT_TRUE(red.too_bright);
    EXPECT_FLOAT_EQ(red.rgb.x, 0.99f);
    EXPECT_NEAR(luminance(red.rgb), 0.4, 1e-6);
}

TEST(MgfColour, ReflectanceAboveTheBoundIsReducedToIt) {
    const Rec709Colour white = to_rec709(Chromaticity{}, 1.0, 0.99);
    EXPECT_TRUE(white.too_bright);
    EXPECT_EQ(white.rgb, Rgb(0.99f, 0.99f, 0.99f));
}

void expect_chromaticity(const Chromaticity& c, double x, double y, double tolerance) {
    EXPECT_NEAR(c.x, x, tolerance);
    EXPECT_NEAR(c.y, y, tolerance);
}

TEST(MgfColour, FlatSpectrumIsNeutral) {
    expect_chromaticity(chromaticity_of_spectrum(380, 780, std::vector<double>{3, 3}), 1.0 / 3, 1.0 / 3, 1e-12);
    expect_chromaticity(chromaticity_of_spectrum(100, 2000, std::vector<double>(50, 0.2)), 1.0 / 3, 1.0 / 3, 1e-12);
}

TEST(MgfColour, NarrowSpectrumIsOnTheSpectralLocus) {
    // CIE 1931 at 520 nm and 600 nm; the tolerance covers the table's step of 10 nm.
    expect_chromaticity(chromaticity_of_spectrum(519, 521, std::vector<double>{1, 1}), 0.0743, 0.8338, 5e-3);
    expect_chromaticity(chromaticity_of_spectrum(599, 601, std::vector<double>{1, 1}), 0.6270, 0.3725, 5e-3);
}

TEST(MgfColour, SpectrumWithoutVisibleLightIsRefused) {
    EXPECT_THROW(chromaticity_of_spectrum(800, 900, std::vector<double>{1, 1}), std::invalid_argument);
    EXPECT_THROW(chromaticity_of_spectrum(380, 780, std::vector<double>{0, 0, 0}), std::invalid_argument);
    EXPECT_THROW(chromaticity_of_spectrum(780, 380, std::vector<double>{1, 1}), std::invalid_argument);
}

TEST(MgfColour, BlackBodies) {
    // Planckian locus, CIE 1931; 2856 K is close to illuminant A.
    expect_chromaticity(chromaticity_of_black_body(2856), 0.4476, 0.4074, 1e-3);
    expect_chromaticity(chromaticity_of_black_body(6500), 0.3135, 0.3237, 1e-3);
    EXPECT_THROW(chromaticity_of_black_body(999), std::invalid_argument);
}

/// S0, S1, S2 of CIE daylight (CIE 15, table T.2) from 380 to 780 nm, every 10 nm.
const std::vector<double> daylight_basis[] = {
    {63.4,  65.8,  94.8,  104.8, 105.9, 96.8, 113.9, 125.6, 125.5, 121.3, 121.3, 113.5, 113.1, 110.8,
     106.5, 108.8, 105.3, 104.4, 100.0, 96.0, 95.1,  89.1,  90.5,  90.3,  88.4,  84.0,  85.1,  81.9,
     82.6,  84.9,  81.3,  71.9,  74.3,  76.4, 63.3,  71.7,  77.0,  65.2,  47.7,  68.6,  65.0},
    {38.5,  35.0,  43.4,  46.3,  43.9,  37.1,  36.7,  35.9,  32.6,  27.9,  24.3, 20.1,  16.2,  13.2,
     8.6,   6.1,   4.2,   1.9,   0.0,   -1.6,  -3.5,  -3.5,  -5.8,  -7.2,  -8.6, -9.5,  -10.9, -10.7,
     -12.0, -14.0, -13.6, -12.0, -13.3, -12.9, -10.6, -11.6, -12.2, -10.2, -7.8, -11.2, -10.4},
    {3.0,  1.2,  -1.1, -0.5, -0.7, -1.2, -2.6, -2.9, -2.8, -2.6, -2.6, -1.8, -1.5, -1.3,
     -1.2, -1.0, -0.5, -0.3, 0.0,  0.2,  0.5,  2.1,  3.2,  4.1,  4.7,  5.1,  6.7,  7.3,
     8.6,  9.8,  10.2, 8.3,  9.6,  8.5,  7.0,  7.6,  8.0,  6.7,  5.2,  7.4,  6.8}};

Chromaticity daylight(double m1, double m2) {
    std::vector<double> sum;
    for (std::size_t i = 0; i < daylight_basis[0].size(); ++i)
        sum.push_back(daylight_basis[0][i] + m1 * daylight_basis[1][i] + m2 * daylight_basis[2][i]);
    return chromaticity_of_spectrum(380, 780, sum);
}

// Seen to fail while a negative tristimulus value was refused.
TEST(MgfColour, TheBasisOfDaylightIsLegal) {
    // D65 is S0 - 0.2965 S1 - 0.6883 S2 (CIE 15); the tolerance covers the steps of 20 nm. The table's white of equal
    // energy is (1, 1, 1).
    expect_chromaticity(daylight(-0.2965, -0.6883), 0.3127, 0.3290, 5e-4);
    for (const auto& values : daylight_basis) {
        const Chromaticity c = chromaticity_of_spectrum(380, 780, values);
        const Rec709Colour colour = to_rec709(c, 0.05, 0.99);
        EXPECT_NEAR(luminance(colour.rgb), 0.05, 1e-6);
        EXPECT_GE(std::min({colour.rgb.x, colour.rgb.y, colour.rgb.z}), 0);
    }
    const auto negative = chromaticity_of_spectrum(380, 780, daylight_basis[2]);
    EXPECT_TRUE(to_rec709(negative, 0.05, 0.99).out_of_gamut);
}

TEST(MgfColour, NegativeWeightsTakeAway) {
    // (1 + 3, 4, ...) of the test below, minus the second part.
    const MixedColour parts[] = {{1, {0.5, 0.25}}, {3, {0.25, 0.5}}, {-3, {0.25, 0.5}}};
    expect_chromaticity(mix(parts), 0.5, 0.25, 1e-12);
}

TEST(MgfColour, MixtureWeighsByLuminance) {
    // X = 1 * 0.5/0.25 + 3 * 0.25/0.5, Y = 1 + 3, Z = 1 * 0.25/0.25 + 3 * 0.25/0.5.
    const MixedColour parts[] = {{1, {0.5, 0.25}}, {3, {0.25, 0.5}}};
    expect_chromaticity(mix(parts), 3.5 / 10, 4.0 / 10, 1e-12);
    EXPECT_THROW(mix(std::vector<MixedColour>{{0, {}}, {0, {}}}), std::invalid_argument);
    EXPECT_THROW(mix(std::vector<MixedColour>{{1, {}}, {-2, {}}}), std::invalid_argument);
    EXPECT_THROW(mix(std::vector<MixedColour>{{-1, {}}, {1, {}}}), std::invalid_argument);
}

}  // namespace
}  // namespace interflect
