#include "interflect/formats/mgf_colour.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace interflect {
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
    // 0.5); adapted (0.93853, 0.99530, 0.54420); RGB = (1.24006, 0.98011, 0.42450), of luminance 0.99526, divided out.
    expect_near(to_rec709({0.4, 0.4}, 1, unbounded).rgb, Rgb(1.2460f, 0.9848f, 0.4265f), 2e-4f);
}

TEST(MgfColour, LuminanceIsKeptForEveryChromaticity) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 10'000; ++i) {
        double x = uniform(random), y = uniform(random);
        if (x + y > 1) x = 1 - x, y = 1 - y;
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
    // CIE 1931 at 520 nm and 600 nm; the table's step of 10 nm shows.
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

TEST(MgfColour, MixtureWeighsByLuminance) {
    // X = 1 * 0.5/0.25 + 3 * 0.25/0.5, Y = 1 + 3, Z = 1 * 0.25/0.25 + 3 * 0.25/0.5.
    const MixedColour parts[] = {{1, {0.5, 0.25}}, {3, {0.25, 0.5}}};
    expect_chromaticity(mix(parts), 3.5 / 10, 4.0 / 10, 1e-12);
    EXPECT_THROW(mix(std::vector<MixedColour>{{0, {}}, {0, {}}}), std::invalid_argument);
    EXPECT_THROW(mix(std::vector<MixedColour>{{-1, {}}, {2, {}}}), std::invalid_argument);
}

}  // namespace
}  // namespace interflect
