#include "interflect/plots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "interflect/core.h"
#include "interflect/image.h"

namespace interflect {

using namespace detail;
namespace {

using Values = std::vector<float>;
constexpr Spacing linear = Spacing::linear, logarithmic = Spacing::logarithmic;

void expect_values(const ColourScale& scale, int most, const Values& expected) {
    const Values found = round_values(scale, most);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_FLOAT_EQ(found[i], expected[i]);
}

TEST(RoundValues, OfALinearScale) {
    expect_values({0, 1, linear}, 7, {0, 0.2f, 0.4f, 0.6f, 0.8f, 1});
    expect_values({0, 5, linear}, 7, {0, 1, 2, 3, 4, 5});
    expect_values({0, 16, linear}, 7, {0, 5, 10, 15});
    expect_values({-2, 2, linear}, 5, {-2, -1, 0, 1, 2});
}

TEST(RoundValues, OfALogarithmicScale) {
    expect_values({0.1f, 10, logarithmic}, 7, {0.1f, 0.2f, 0.5f, 1, 2, 5, 10});
    expect_values({0.1f, 10, logarithmic}, 6, {0.1f, 1, 10});
    expect_values({2e-3f, 3e3f, logarithmic}, 6, {0.01f, 0.1f, 1, 10, 100, 1000});
    expect_values({2e-3f, 3e3f, logarithmic}, 5, {0.01f, 1, 100});
}

TEST(RoundValues, OfLessThanADecadeAreMultiples) { expect_values({30, 72, logarithmic}, 5, {30, 40, 50, 60, 70}); }

TEST(RoundValues, AreNeverTooManyNorBeyondTheEnds) {
    for (const float low : {1e-6f, 0.013f, 0.9f, 77.0f})
        for (const float ratio : {1.01f, 3.0f, 9.9f, 10.0f, 1e4f, 1e6f})
            for (const Spacing spacing : {linear, logarithmic})
                for (int most = 3; most < 20; ++most) {
                    const ColourScale scale{low, low * ratio, spacing};
                    const Values values = round_values(scale, most);
                    const float allowed = 1e-5f * scale.high;
                    EXPECT_LE(static_cast<int>(values.size()), most) << low << " x " << ratio;
                    EXPECT_GE(values.size(), 1u) << low << " x " << ratio;
                    EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
                    for (const float value : values) {
                        EXPECT_GE(value, low - allowed);
                        EXPECT_LE(value, scale.high + allowed);
                    }
                }
}

constexpr ColourScale scale{0, 5, linear};
const Rgb red(1, 0, 0);

TEST(Legend, LiesBelowThePicture) {
    const Image image = with_legend(Image(640, 30, red), scale, "level");
    ASSERT_EQ(image.width, 640);
    ASSERT_EQ(image.height, 30 + legend_height(640));
    for (std::size_t i = 0; i < 640u * 30; ++i) EXPECT_EQ(image.pixels[i], red);
    for (std::size_t i = 640u * 30; i < image.pixels.size(); ++i) EXPECT_NE(image.pixels[i], red);
}

/// Some row has the colours of the scale from its left end to its right end.
TEST(Legend, HasAStripOfTheColours) {
    const Image image = with_legend(Image(640, 1), scale, "");
    int rows = 0;
    for (int y = 1; y < image.height; ++y) {
        int x = 0;
        for (int step = 0; step <= 50; ++step)  // coarser than a pixel
            while (x < image.width && (image.at(x, y) - false_colour(static_cast<float>(step) / 50)).length() > 0.02f)
                ++x;
        rows += x < image.width;
    }
    EXPECT_GT(rows, 5);
}

TEST(Legend, ShowsTheTitleAndTheRange) {
    const auto legend = [](const ColourScale& of, const std::string& title) {
        return with_legend(Image(640, 1), of, title).pixels;
    };
    EXPECT_EQ(legend(scale, "level"), legend(scale, "level"));
    EXPECT_NE(legend(scale, "level"), legend(scale, "rays"));
    EXPECT_NE(legend(scale, "level"), legend({0, 50, linear}, "level")) << "ticks in the same places";
}

TEST(Legend, GrowsWithThePictureAndIsCutOffInASmallOne) {
    EXPECT_EQ(legend_height(6 * 512), 6 * legend_height(512));
    for (const int width : {1, 3, 20, 100})
        EXPECT_EQ(with_legend(Image(width, 1), scale, "irradiance [lm/m^2]").width, width);
}

/// Text that fits has the same dots as on a wider picture: the right end of the title is complete.
TEST(Legend, FitsWhereNothingIsCutOff) {
    const std::string title = "relative standard error of irradiance";
    EXPECT_TRUE(legend_fits(640, 360, title));
    EXPECT_TRUE(legend_fits(320, 180, "irradiance [lm/m^2]"));
    EXPECT_FALSE(legend_fits(320, 2 * legend_height(320) - 1, "irradiance [lm/m^2]")) << "more legend than picture";
    EXPECT_FALSE(legend_fits(200, 200, "irradiance [lm/m^2]")) << "no room for three numbers";
    EXPECT_FALSE(legend_fits(240, 240, std::string(60, 'm'))) << "no room for the title";
    int least = 1;
    while (!legend_fits(least, 1000, title)) ++least;
    const Image narrow = with_legend(Image(least, 1), scale, title), wide = with_legend(Image(600, 1), scale, title);
    for (int y = 1; y < 16; ++y)  // the title's rows
        for (int x = 0; x < 600; ++x)
            EXPECT_EQ(wide.at(x, y), x < least ? narrow.at(x, y) : wide.at(0, 1)) << x << ", " << y;
}

TEST(Legend, RefusesWhatItCannotDraw) {
    const float infinite = std::numeric_limits<float>::infinity();
    EXPECT_THROW(with_legend(Image(640, 1), scale, "m\xb2"), InputError);
    EXPECT_THROW(legend_fits(640, 360, "two\nlines"), InputError);
    EXPECT_THROW(with_legend(Image(), scale, "level"), InputError);
    EXPECT_THROW(round_values(scale, 2), InputError);
    for (const ColourScale& broken : {ColourScale{1, 1, linear}, ColourScale{0, infinite, linear},
                                      ColourScale{0, 1, logarithmic}, ColourScale{std::nanf(""), 1, linear}})
        EXPECT_THROW(with_legend(Image(640, 1), broken, "level"), InputError);
}

TEST(Legend, IsRefusedWhereTheImageGetsTooLarge) {
    Image wide;  // without its pixels, which are not accessed
    wide.width = max_image_pixels / 4;
    wide.height = 4;
    EXPECT_THROW(with_legend(wide, scale, "level"), InputError);
}

}  // namespace
}  // namespace interflect
