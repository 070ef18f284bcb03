#include "interflect/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "interflect/core.h"
#include "interflect/image.h"

namespace interflect {

using namespace detail;
namespace {

Rgb uniform_grey(float v) { return Rgb(v, v, v); }

Image speckle(int width, int height, float mean, float amplitude) {
    Image image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = uniform_grey(mean + amplitude * (static_cast<float>(i * 7 % 11) / 5 - 1));
    return image;
}

TEST(Compare, EqualImagesDoNotDiffer) {
    for (const Image& image : {speckle(18, 9, 2, 1), Image(4, 4)}) {
        const ImageDifference d = compare(image, image);
        EXPECT_EQ(d.ratio_of_means, 1);
        EXPECT_EQ(d.rmse, 0);
        EXPECT_EQ(d.relative_mse, 0);
        EXPECT_EQ(d.maximum, 0);
        EXPECT_EQ(d.perceptual_distance, 0);
        EXPECT_EQ(d.flip, 0);
        for (const BlockDifference& block : d.blocks) EXPECT_EQ(block.relative_rmse, 0);
    }
}

/// Reference: 1 and 3. Image: 1 and 4 in red only. By hand, with Rec. 709's weight of red, 0.2126.
TEST(Compare, KnownByHand) {
    Image reference(2, 1, uniform_grey(1)), image(2, 1, uniform_grey(1));
    reference.at(1, 0) = uniform_grey(3);
    image.at(1, 0) = Rgb(4, 3, 3);
    const ImageDifference d = compare(image, reference);
    EXPECT_NEAR(d.ratio_of_means, (1 + 3 + 0.2126) / 4, 1e-6);
    EXPECT_NEAR(d.rmse, std::sqrt(1.0 / 6), 1e-6);
    EXPECT_NEAR(d.relative_mse, 1 / (9 + 0.02 * 0.02) / 6, 1e-6);
    EXPECT_EQ(d.maximum, 1);
    EXPECT_EQ(d.blocks[0].block, 1);
    EXPECT_NEAR(d.blocks[0].relative_rmse, 0.2126 / 3.02 / std::sqrt(2), 1e-6);
}

/// A constant factor appears in every block, and `scale` removes it.
TEST(Compare, AFactorShowsInEveryBlockAndCanBeDividedOut) {
    const Image reference(18, 18, uniform_grey(2)), image(18, 18, uniform_grey(3));
    for (const BlockDifference& block : compare(image, reference).blocks) {
        EXPECT_NEAR(block.relative_rmse, 1 / 2.02, 1e-6);
        EXPECT_NEAR(block.trimmed_relative_rmse, 1 / 2.02, 1e-6);
    }
    const ImageDifference scaled = compare(image, reference, {.scale = true});
    EXPECT_EQ(scaled.ratio_of_means, 1.5);
    EXPECT_NEAR(scaled.rmse, 0, 1e-6);
    EXPECT_NEAR(scaled.blocks[2].relative_rmse, 0, 1e-6);
}

TEST(Compare, NoiseAveragesOutInBlocks) {
    const ImageDifference d = compare(speckle(90, 90, 2, 1), Image(90, 90, uniform_grey(2)));
    EXPECT_GT(d.blocks[0].relative_rmse, 0.25);
    EXPECT_LT(d.blocks[1].relative_rmse, d.blocks[0].relative_rmse / 4);
    EXPECT_LT(d.blocks[2].relative_rmse, d.blocks[1].relative_rmse);
}

/// One block of 10 x 10 = 100 is wrong: it has the whole error, and is the omitted percent.
TEST(Compare, TrimmingLeavesTheWorstPercentOut) {
    Image reference(50, 50, uniform_grey(1)), image = reference;
    image.at(12, 31) = uniform_grey(26);  // its block of 5 x 5 has mean 2
    const BlockDifference blocks = compare(image, reference).blocks[1];
    EXPECT_EQ(blocks.block, 5);
    EXPECT_NEAR(blocks.relative_rmse, 0.1 / 1.01, 1e-6);
    EXPECT_EQ(blocks.trimmed_relative_rmse, 0);
}

TEST(Compare, WhatIsLeftOverAtTheBordersIsNoBlock) {
    Image reference(7, 6, uniform_grey(1)), image = reference;
    image.at(6, 0) = image.at(0, 5) = uniform_grey(9);
    EXPECT_EQ(compare(image, reference).blocks[1].relative_rmse, 0);  // one block of 5 x 5
    EXPECT_EQ(compare(image, reference).blocks[2].relative_rmse, 0);  // no block of 9 x 9
    EXPECT_GT(compare(image, reference).blocks[0].relative_rmse, 0);
}

TEST(Compare, DoesNotDependOnTheUnit) {
    const Image reference = speckle(18, 18, 3, 1), image = speckle(18, 18, 3, 2);
    Image small_reference = reference, small_image = image;
    for (Rgb& pixel : small_reference.pixels) pixel /= 1024;
    for (Rgb& pixel : small_image.pixels) pixel /= 1024;
    const ImageDifference a = compare(image, reference), b = compare(small_image, small_reference);
    EXPECT_NEAR(a.relative_mse, b.relative_mse, 1e-9);
    EXPECT_NEAR(a.blocks[0].relative_rmse, b.blocks[0].relative_rmse, 1e-9);
    EXPECT_NEAR(a.rmse, 1024 * b.rmse, 1e-6);
    EXPECT_NEAR(a.perceptual_distance, b.perceptual_distance, 1e-9);
    EXPECT_NEAR(a.flip, b.flip, 1e-5);
    EXPECT_GT(a.flip, 0);
}

TEST(Compare, AveragesALargerImageToTheReferencesSize) {
    Image image(4, 2, uniform_grey(1));
    image.at(2, 0) = uniform_grey(5);  // the right half's mean is 2
    Image reference(2, 1, uniform_grey(1));
    reference.at(1, 0) = uniform_grey(2);
    const ImageDifference d = compare(image, reference);
    EXPECT_EQ(d.maximum, 0);
    EXPECT_EQ(d.perceptual_distance, 0);
    EXPECT_EQ(d.flip, 0);
    EXPECT_EQ(d.flip_map.width, 2);
    EXPECT_EQ(d.flip_map.height, 1);
}

TEST(Compare, PerceptualDistanceIsThatOfTheFieldOfView) {
    const Image reference = speckle(18, 9, 3, 1), image = speckle(18, 9, 3, 2);
    EXPECT_EQ(compare(image, reference).perceptual_distance, perceptual_distance(image, reference, 45));
    EXPECT_EQ(compare(image, reference, {.field_of_view = 3}).perceptual_distance,
              perceptual_distance(image, reference, 3));
    EXPECT_THROW(compare(image, reference, {.field_of_view = 180}), InputError);
}

/// Both use the reference's exposure, so a darker image stays darker. 8-bit files are shown without a change.
TEST(Compare, FlipIsThatOfWhatADisplayShows) {
    const Image reference = speckle(18, 9, 300, 100), image = speckle(18, 9, 150, 50);
    const float exposure = automatic_exposure(reference);
    const Image map =
        flip_map(tone_map(image, exposure, Tonemap::filmic), tone_map(reference, exposure, Tonemap::filmic));
    const ImageDifference d = compare(image, reference);
    EXPECT_EQ(d.flip_map.pixels, map.pixels);
    double sum = 0;
    for (const Rgb& pixel : map.pixels) sum += pixel.x;
    EXPECT_NEAR(d.flip, sum / (18 * 9), 1e-9);
    EXPECT_GT(d.flip, 0.1);

    const Image shown = speckle(18, 9, 0.5f, 0.3f), expected(18, 9, uniform_grey(0.5f));
    EXPECT_EQ(compare(shown, expected, {.tone_mapped = true}).flip_map.pixels, flip_map(shown, expected).pixels);
}

TEST(Compare, RefusesSizesThatAreNoWholeMultiple) {
    for (const auto& [width, height] : {std::pair{5, 2}, {4, 3}, {8, 2}, {1, 1}, {0, 0}}) {
        try {
            compare(Image(width, height), Image(2, 1));
            ADD_FAILURE() << width << " x " << height;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("with a reference of 2 x 1"));
        }
    }
    EXPECT_THROW(compare(Image(2, 2), Image()), InputError);
    Image lacks_pixels(2, 2);
    lacks_pixels.pixels.resize(3);
    EXPECT_THROW(compare(Image(2, 2), lacks_pixels), InputError);
    EXPECT_THROW(compare(lacks_pixels, Image(2, 2)), InputError);
}

TEST(Compare, CountsPixelsThatAreNotFinite) {
    Image image(2, 2, uniform_grey(1)), reference = image;
    image.at(0, 0).y = std::numeric_limits<float>::quiet_NaN();
    reference.at(1, 1).z = std::numeric_limits<float>::infinity();
    const ImageDifference d = compare(image, reference);
    EXPECT_EQ(d.non_finite_pixels, 2);
    EXPECT_TRUE(std::isnan(d.rmse));
    EXPECT_TRUE(std::isnan(d.perceptual_distance));
    EXPECT_TRUE(std::isnan(d.flip));
    EXPECT_TRUE(d.flip_map.pixels.empty());
    EXPECT_TRUE(std::isnan(d.blocks[1].relative_rmse));
}

TEST(Compare, LightWhereTheReferenceIsBlackIsInfinitelyMuch) {
    const ImageDifference d = compare(Image(2, 2, uniform_grey(1)), Image(2, 2));
    EXPECT_TRUE(std::isinf(d.ratio_of_means));
    EXPECT_TRUE(std::isinf(d.relative_mse));
    EXPECT_TRUE(std::isinf(d.perceptual_distance));
    EXPECT_EQ(d.rmse, 1);
}

}  // namespace
}  // namespace interflect
