#include "interflect/plots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "interflect/core.h"
#include "interflect/image/plots/lettering.h"

namespace interflect {

using namespace detail;
namespace {

const Rgb background(0.25f);
constexpr ColourScale bright_lines{0, 1000, Spacing::linear}, dark_lines{0, 1, Spacing::linear};

template <class Value>
Image values_of(int width, int height, const Value& value) {
    Image values(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            values.at(x, y) = Rgb(value(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    return values;
}

Image lines(const Image& values, const std::vector<float>& levels, const ColourScale& scale = bright_lines) {
    return with_isolines(Image(values.width, values.height, background), values, levels, scale);
}

float coverage(const Rgb& pixel) { return (pixel.x - background.x) / (1 - background.x); }

TEST(Isolines, LieWhereTheValueIs) {
    const Image image = lines(values_of(64, 48, [](float x, float) { return x; }), {20.3f});
    for (int y = 0; y < image.height; ++y) {
        float sum = 0, moment = 0;
        for (int x = 0; x < image.width; ++x) {
            sum += coverage(image.at(x, y));
            moment += coverage(image.at(x, y)) * (static_cast<float>(x) + 0.5f);
        }
        EXPECT_NEAR(sum, 1, 1e-3) << "the width of a line";
        EXPECT_NEAR(moment / sum, 20.3, 0.1);
    }
}

TEST(Isolines, CloseAroundAPeak) {
    const auto radius = [](float x, float y) { return std::hypot(x - 50, y - 40); };
    const Image image = lines(values_of(100, 80, radius), {30});
    double covered = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float r = radius(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            if (image.at(x, y) == paper || image.at(x, y) == ink) continue;
            EXPECT_TRUE(std::abs(r - 30) < 1.5f || image.at(x, y) == background) << x << ", " << y;
            covered += coverage(image.at(x, y));
        }
    EXPECT_GT(covered, 2 * 3.14159 * 30 - 40) << "but for what a number hides";
}

TEST(Isolines, EndWhereTheValueJumps) {
    const Image values = values_of(64, 48, [](float x, float) { return x < 30 ? 0.0f : 100.0f; });
    EXPECT_EQ(lines(values, {50}).pixels, Image(64, 48, background).pixels);
}

TEST(Isolines, LeaveNoiseOut) {
    const auto bump = [](float x, float y) { return 10 - 0.02f * ((x - 30) * (x - 30) + (y - 20) * (y - 20)); };
    const Image values = values_of(64, 48, bump);
    EXPECT_EQ(lines(values, {9.95f}).pixels, Image(64, 48, background).pixels) << "a circle of 1.6 pixels";
    EXPECT_NE(lines(values, {8}).pixels, Image(64, 48, background).pixels) << "and one of 10";
}

/// A ridge on the diagonal: after smoothing it is 97.81 high, 97.27 beside it, and 97.54 in the middle between four
/// pixel centres. Below that, lines run along the ridge on both sides; above, each pixel of the ridge is an island.
TEST(Isolines, FollowARidge) {
    const Image values = values_of(48, 48, [](float x, float y) { return 100 - 2 * std::abs(x - y); });
    double covered = 0;
    for (const Rgb& pixel : lines(values, {97.4f}).pixels) covered += coverage(pixel);
    EXPECT_GT(covered, 1.414 * 48) << "more than one line: the two are less than two pixels apart";
    EXPECT_EQ(lines(values, {97.7f}).pixels, Image(48, 48, background).pixels);
}

TEST(Isolines, LongOnesHaveTheirNumber) {
    const Image values = values_of(200, 120, [](float x, float) { return x; });
    const auto has = [&](const Image& image, const Rgb& colour) {
        return std::find(image.pixels.begin(), image.pixels.end(), colour) != image.pixels.end();
    };
    EXPECT_TRUE(has(lines(values, {100}), paper) && has(lines(values, {100}), ink));
    EXPECT_FALSE(has(lines(values, {3}), paper)) << "there is no room";
    EXPECT_FLOAT_EQ(lines(values, {100.5f}).at(100, 2).x, 1) << "white where the scale is dark";
    EXPECT_FLOAT_EQ(lines(values, {100.5f}, dark_lines).at(100, 2).x, 0);
}

TEST(Isolines, OfNothing) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float value : {0.0f, 5.0f, nan})
        EXPECT_EQ(lines(Image(40, 30, Rgb(value)), {1}).pixels, Image(40, 30, background).pixels);
    EXPECT_EQ(lines(Image(1, 1, Rgb(2)), {1}).pixels, Image(1, 1, background).pixels);
    EXPECT_THROW(with_isolines(Image(3, 2), Image(2, 3), {}, bright_lines), InputError);
}

}  // namespace
}  // namespace interflect
