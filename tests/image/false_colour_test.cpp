#include "interflect/plots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace interflect {

using namespace detail;
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr int steps = 100;

Rgb colour_at(int step) { return false_colour(static_cast<float>(step) / steps); }

/// Computes CIE 1976 L*: perceived lightness of a linear colour, 0 to 100.
float lightness(const Rgb& colour) { return 116 * std::cbrt(luminance(colour)) - 16; }

TEST(FalseColour, StaysWithinTheDisplaysGamut) {
    for (int i = 0; i <= steps; ++i)
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(colour_at(i)[c], 0) << i;
            EXPECT_LE(colour_at(i)[c], 1) << i;
        }
}

TEST(FalseColour, LightnessRisesEvenly) {
    const float whole = lightness(false_colour(1)) - lightness(false_colour(0));
    EXPECT_GT(whole, 70);
    for (int i = 0; i < steps; ++i)
        EXPECT_NEAR(lightness(colour_at(i + 1)) - lightness(colour_at(i)), whole / steps, 0.4f * whole / steps) << i;
}

/// Inverse of the map's conversion: Oklab (Ottosson 2020), where distances approximate perceived differences.
V3f oklab(const Rgb& c) {
    const float l = std::cbrt(0.4122214708f * c.x + 0.5363325363f * c.y + 0.0514459929f * c.z);
    const float m = std::cbrt(0.2119034982f * c.x + 0.6806995451f * c.y + 0.1073969566f * c.z);
    const float s = std::cbrt(0.0883024619f * c.x + 0.2817188376f * c.y + 0.6299787005f * c.z);
    return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
            1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
            0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}

TEST(FalseColour, EqualStepsLookAboutEqual) {
    float least = 1, most = 0;
    for (int i = 0; i < steps; ++i) {
        const float distance = (oklab(colour_at(i + 1)) - oklab(colour_at(i))).length();
        least = std::min(least, distance);
        most = std::max(most, distance);
    }
    EXPECT_LT(most / least, 1.3f);
    EXPECT_GT(least * steps, 0.6f) << "and are as large as the gamut allows";
}

TEST(FalseColour, GoesFromVioletOverTealToYellow) {
    const Rgb violet = false_colour(0), teal = false_colour(0.5f), yellow = false_colour(1);
    EXPECT_TRUE(violet.x > violet.y && violet.z > violet.y);
    EXPECT_TRUE(teal.y > teal.x && teal.z > teal.x);
    EXPECT_TRUE(yellow.x > yellow.z && yellow.y > yellow.z);
}

TEST(FalseColour, ClampsButShowsWhatIsNotANumber) {
    EXPECT_LT((false_colour(-1) - false_colour(0)).length(), 1e-5f);
    EXPECT_LT((false_colour(2) - false_colour(1)).length(), 1e-5f);
    EXPECT_FALSE(is_finite(false_colour(std::nanf(""))));
}

TEST(ColourScale, PlacesValues) {
    const ColourScale linear{2, 4, Spacing::linear}, logarithmic{0.1f, 1000, Spacing::logarithmic};
    EXPECT_EQ(linear.position(2), 0);
    EXPECT_EQ(linear.position(3.5f), 0.75f);
    EXPECT_EQ(linear.position(infinite), 1);
    EXPECT_EQ(logarithmic.position(0), 0);
    EXPECT_FLOAT_EQ(logarithmic.position(1), 0.25f);
    EXPECT_FLOAT_EQ(logarithmic.position(10), 0.5f);
    EXPECT_EQ(logarithmic.position(1e9f), 1);
}

void expect_range(const ColourScale& scale, float low, float high) {
    EXPECT_FLOAT_EQ(scale.low, low);
    EXPECT_FLOAT_EQ(scale.high, high);
    EXPECT_LT(scale.low, scale.high);
}

TEST(FitScale, LinearIsFromZeroToTheLargest) {
    expect_range(fit_scale({3, infinite, 5, 4}, Spacing::linear), 0, 5);
    expect_range(fit_scale({-2, 1}, Spacing::linear), -2, 1);
}

TEST(FitScale, LogarithmicLeavesOutTheExtremes) {
    std::vector<float> values{0, 1e-3f, 1e9f, std::nanf("")};  // outliers, each a thousandth of the values
    for (int i = 0; i < 1000; ++i) values.push_back(2 + static_cast<float>(i % 10));
    expect_range(fit_scale(values, Spacing::logarithmic), 2, 11);
}

TEST(FitScale, LogarithmicHasSixDecadesAtMost) {
    expect_range(fit_scale({1e-20f, 10}, Spacing::logarithmic), 1e-5f, 10);
}

TEST(FitScale, AlwaysHasARange) {
    expect_range(fit_scale({}, Spacing::linear), 0, 1);
    expect_range(fit_scale({0, 0}, Spacing::linear), 0, 1);
    expect_range(fit_scale({-1}, Spacing::linear), -1, 1);
    expect_range(fit_scale({0, infinite}, Spacing::logarithmic), 0.1f, 1);
    expect_range(fit_scale({7, 7}, Spacing::logarithmic), 0.7f, 7);
}

TEST(RoundScale, EndsAtARoundNumber) {
    for (const auto& [highest, expected] :
         {std::pair(0.9f, 1.0f), std::pair(1.0f, 1.0f), std::pair(1.2f, 1.5f), std::pair(540.0f, 600.0f),
          std::pair(81.0f, 100.0f), std::pair(0.03f, 0.03f)}) {
        const ColourScale scale = fit_round_scale({highest / 3, highest});
        EXPECT_EQ(scale.low, 0);
        EXPECT_FLOAT_EQ(scale.high, expected);
        EXPECT_EQ(scale.spacing, Spacing::linear);
    }
}

TEST(RoundScale, LampsDoNotDecide) {
    std::vector<float> values(1000, 290.0f);
    std::fill_n(values.begin(), 15, 1e6f);
    std::fill_n(values.begin() + 100, 500, 0.0f);
    values[700] = infinite;
    EXPECT_FLOAT_EQ(fit_round_scale(values).high, 1e6f) << "15 of 484 lit pixels are more than 2%";
    std::fill_n(values.begin(), 10, 200.0f);
    EXPECT_FLOAT_EQ(fit_round_scale(values).high, 300);
    EXPECT_EQ(fit_round_scale({0, -1, infinite}).high, 1);
}

TEST(FalseColours, OfAPicture) {
    Image values(4, 1);
    values.at(1, 0) = Rgb(5);
    values.at(2, 0) = Rgb(20);
    values.at(3, 0) = Rgb(infinite);
    const Image shown = false_colours(values, {0, 10, Spacing::linear});
    EXPECT_EQ(shown.at(0, 0), Rgb(0)) << "nothing is black";
    EXPECT_EQ(shown.at(1, 0), false_colour(0.5f));
    EXPECT_EQ(shown.at(2, 0), false_colour(1));
    EXPECT_EQ(shown.at(3, 0), Rgb(infinite));
}

}  // namespace
}  // namespace interflect
