#include "interflect/image/false_colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace interflect {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr int steps = 100;

Rgb colour_at(int step) { return false_colour(static_cast<float>(step) / steps); }

/// CIE 1976 L*: how light a linear colour looks, 0 to 100.
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
    std::vector<float> values{0, 1e-3f, 1e9f, std::nanf("")};  // each one of a thousand
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

}  // namespace
}  // namespace interflect
