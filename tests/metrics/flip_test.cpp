#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "interflect/core.h"
#include "interflect/metrics.h"
#include "interflect/plots.h"

namespace interflect {

using namespace detail;
namespace {

Rgb grey(float v) { return Rgb(v); }

double mean(const Image& map) {
    double sum = 0;
    for (const Rgb& pixel : map.pixels) sum += pixel.x;
    return sum / static_cast<double>(map.pixels.size());
}

/// Colours all over the cube, dark and light, fine and coarse.
Image pattern(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.at(x, y) =
                Rgb(static_cast<float>((5 * x + 3 * y) % 17) / 16, static_cast<float>((x * x + 2 * y) % 13) / 12,
                    static_cast<float>((x * y + 7) % 11) / 10);
    return image;
}

Image mirrored(const Image& image) {
    Image result = image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) result.at(x, y) = image.at(image.width - 1 - x, y);
    return result;
}

double flip_of_colours(const Rgb& image, const Rgb& reference) {
    return flip_map(Image(3, 2, image), Image(3, 2, reference)).at(1, 1).x;
}

/// A uniform colour has neither edges nor details, so only the distance of two colours remains, HyAB^0.7. Its largest
/// value is 41.2760, for green and blue. Black and white are 100 apart in lightness: 100^0.7 = 25.1189 is above the
/// knee 0.4 x 41.2760 = 16.5104, so 0.95 + 0.05 (25.1189 - 16.5104) / (41.2760 - 16.5104) = 0.96738.
TEST(Flip, OfBlackAndWhiteByHand) { EXPECT_NEAR(flip_of_colours(grey(0), grey(1)), 0.96738, 1e-4); }

TEST(Flip, OfGreenAndBlueIsOne) { EXPECT_NEAR(flip_of_colours(Rgb(0, 1, 0), Rgb(0, 0, 1)), 1, 1e-6); }

/// L* = 116 Y^(1/3) - 16: 0.125 has 42, 0.216 has 53.6. 11.6^0.7 = 5.5605 is below the knee: 0.95 x 5.5605 / 16.5104 =
/// 0.31995.
TEST(Flip, OfTwoGreysByHand) { EXPECT_NEAR(flip_of_colours(grey(0.125f), grey(0.216f)), 0.31995, 1e-4); }

/// Numbers from the formulas of the paper's reference implementation (github.com/NVlabs/flip, python/flip_api.py of
/// version 1.2), evaluated in double precision with full square kernels instead of separated ones.
TEST(Flip, AgreesWithTheReferenceImplementation) {
    const Image reference = pattern(24, 16), image = mirrored(reference);
    const Image map = flip_map(image, reference);
    EXPECT_NEAR(mean(map), 0.388988, 2e-4);
    EXPECT_NEAR(map.at(0, 0).x, 0.968202, 2e-4);
    EXPECT_NEAR(map.at(7, 5).x, 0.411650, 2e-4);
    EXPECT_NEAR(map.at(23, 15).x, 0.670011, 2e-4);

    const Image coarse = flip_map(image, reference, {.pixels_per_degree = 12});
    EXPECT_NEAR(mean(coarse), 0.859326, 2e-4);
    EXPECT_NEAR(coarse.at(7, 5).x, 0.611389, 2e-4);
}

TEST(Flip, OfEqualImagesIsZero) {
    for (const Rgb& pixel : flip_map(pattern(24, 16), pattern(24, 16)).pixels) EXPECT_EQ(pixel, Rgb(0));
}

TEST(Flip, DoesNotDependOnWhichIsTheReference) {
    const Image a = pattern(24, 16), b = mirrored(a);
    EXPECT_EQ(flip_map(a, b).pixels, flip_map(b, a).pixels);
}

TEST(Flip, LiesBetweenZeroAndOne) {
    Image image = pattern(40, 30), opposite = image;
    for (Rgb& pixel : opposite.pixels) pixel = Rgb(1) - pixel;
    image.at(3, 3) = Rgb(50, -2, 0);  // clamped to the display's range
    for (const double pixels_per_degree : {0.5, 5.0, 67.0, 300.0})
        for (const Rgb& pixel : flip_map(image, opposite, {pixels_per_degree}).pixels) {
            EXPECT_GE(pixel.x, 0);
            EXPECT_LE(pixel.x, 1);
            EXPECT_EQ(pixel, Rgb(pixel.x));
        }
}

TEST(Flip, RisesWithNoise) {
    const Image reference(48, 32, grey(0.4f)), noise = pattern(48, 32);
    double last = 0;
    for (const float amplitude : {0.01f, 0.03f, 0.1f, 0.3f}) {
        Image image = reference;
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] += amplitude * (noise.pixels[i] - grey(0.5f));
        const double flip = mean(flip_map(image, reference));
        EXPECT_GT(flip, 1.5 * last);
        last = flip;
    }
}

/// Lines of one pixel are averaged by vision at many pixels per degree.
TEST(Flip, FineDetailsCountLessFromFarAway) {
    Image lines(48, 32), reference(48, 32, grey(0.5f));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x) lines.at(x, y) = grey(x % 2 == 0 ? 0.4f : 0.6f);
    EXPECT_LT(mean(flip_map(lines, reference, {200})), 0.3 * mean(flip_map(lines, reference, {10})));
}

TEST(Flip, RefusesWhatItCannotCompare) {
    EXPECT_THROW(flip_map(Image(3, 2), Image(2, 3)), InputError);
    EXPECT_THROW(flip_map(Image(), Image()), InputError);
    EXPECT_THROW(show_flip_map(Image()), InputError);
    for (const double pixels_per_degree : {0.0, -1.0, 1001.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(flip_map(Image(3, 2), Image(3, 2), {pixels_per_degree}), InputError) << pixels_per_degree;
}

TEST(Flip, IsShownInFalseColoursFromZeroToOneAboveALegend) {
    Image map(300, 20, Rgb(0));
    map.at(7, 3) = Rgb(1);
    map.at(8, 3) = Rgb(0.5f);
    const Image shown = show_flip_map(map);
    EXPECT_EQ(shown.width, 300);
    EXPECT_EQ(shown.height, 20 + legend_height(300));
    EXPECT_EQ(shown.at(0, 0), false_colour(0));
    EXPECT_EQ(shown.at(7, 3), false_colour(1));
    EXPECT_EQ(shown.at(8, 3), false_colour(0.5f));
}

}  // namespace
}  // namespace interflect
