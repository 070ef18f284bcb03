#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "interflect/core.h"
#include "interflect/image/tone/visual_adaptation.h"
#include "interflect/metrics.h"

namespace interflect {

using namespace detail;
namespace {

using std::numbers::pi;

Rgb grey_of(double v) { return Rgb(static_cast<float>(v)); }

/// An irregular pattern in [-1, 1].
double speckle(int x, int y) { return (x * 7 + y * 13 + x * y * 3) % 11 / 5.0 - 1; }

Image mottled(int width, int height, double mean, double amplitude) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = grey_of(mean + amplitude * speckle(x, y));
    return image;
}

/// Creates a picture whose perceptual response, luminance to the power 0.33, is 1 + contrast cos(...), with the given
/// cycles across and down.
Image grating(int width, int height, int across, int down, double contrast) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double phase = 2 * pi * (1.0 * across * x / width + 1.0 * down * y / height);
            image.at(x, y) = grey_of(std::pow(1 + contrast * std::cos(phase), 1 / 0.33));
        }
    return image;
}

/// A(0) = 2.6 x 0.0192. A(8): 0.114 x 8 = 0.912, 0.912^1.1 = exp(1.1 ln 0.912) = exp(-0.10133) = 0.90364, exp(-0.90364)
/// = 0.40509, so 2.6 (0.0192 + 0.912) x 0.40509 = 0.9808.
TEST(ContrastSensitivity, KnownByHand) {
    EXPECT_NEAR(contrast_sensitivity(0), 0.04992, 1e-6);
    EXPECT_NEAR(contrast_sensitivity(8), 0.9808, 1e-4);
}

TEST(ContrastSensitivity, IsBestAtEightCyclesPerDegreeAndNoBetterThanOne) {
    double best = 0;
    for (double f = 0; f <= 60; f += 0.01)
        if (contrast_sensitivity(f) > contrast_sensitivity(best)) best = f;
    EXPECT_NEAR(best, 8, 0.2);
    EXPECT_LE(contrast_sensitivity(best), 1);
    EXPECT_LT(contrast_sensitivity(50), 0.025);
}

/// The reference is 1 everywhere, so m = 1 and d = c cos(...): D is c / 2 at the grating's frequency and at its
/// negative, 0 elsewhere. The distance is A(f) sqrt(2 (c / 2)^2) = A(f) c / sqrt(2). For a picture of 1 degree with 8
/// cycles down it, f = 8, A = 0.9808, and with c = 0.1 the distance is 0.06935.
TEST(PerceptualDistance, OfAGratingKnownByHand) {
    EXPECT_NEAR(perceptual_distance(grating(32, 32, 0, 8, 0.1), Image(32, 32, grey_of(1)), 1), 0.06935, 1e-5);
}

/// The same formula for any direction, size and field of view. `across` counts per width: 3 cycles across a picture
/// that is 2 degrees high and twice as wide are 3 / 4 cycles per degree.
TEST(PerceptualDistance, OfGratingsGoesByCyclesPerDegree) {
    struct Case {
        int width, height, across, down;
        double field_of_view, cycles_per_degree;
    };
    for (const Case& c : {Case{64, 32, 12, 0, 2, 3}, Case{64, 32, 0, 6, 2, 3}, Case{128, 64, 0, 6, 2, 3},
                          Case{64, 32, 12, 8, 2, 5}, Case{35, 35, 3, 4, 0.5, 10}, Case{22, 11, 3, 0, 2, 0.75}}) {
        const Image reference(c.width, c.height, grey_of(1));
        const Image image = grating(c.width, c.height, c.across, c.down, 0.2);
        EXPECT_NEAR(perceptual_distance(image, reference, c.field_of_view),
                    contrast_sensitivity(c.cycles_per_degree) * 0.2 / std::numbers::sqrt2, 1e-6)
            << c.width << " x " << c.height << ", " << c.across << " across, " << c.down << " down";
    }
}

/// D by its definition, on sizes that fast transforms do not support.
TEST(PerceptualDistance, IsTheSumOverTheSpectrum) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 8}, {7, 13}, {17, 2}, {9, 15}}) {
        const Image image = mottled(width, height, 4, 3), reference = mottled(width, height, 2, 0);
        double power = 0;
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u) {
                std::complex<double> sum = 0;
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x)
                        sum += (std::pow(image.at(x, y).x / 2, 0.33) - 1) *
                               std::polar(1.0, -2 * pi * (1.0 * u * x / width + 1.0 * v * y / height));
                const double f =
                    std::hypot(1.0 * std::min(u, width - u) / width, 1.0 * std::min(v, height - v) / height);
                const double weight = contrast_sensitivity(f * height / 3);
                power += weight * weight * std::norm(sum / (1.0 * width * height));
            }
        EXPECT_NEAR(perceptual_distance(image, reference, 3), std::sqrt(power), 1e-6) << width << " x " << height;
    }
}

TEST(PerceptualDistance, OfEqualImagesIsZero) {
    for (const Image& image : {mottled(18, 10, 2, 1), Image(4, 4)}) EXPECT_EQ(perceptual_distance(image, image, 45), 0);
}

TEST(PerceptualDistance, DoesNotDependOnACommonFactor) {
    const Image image = mottled(24, 18, 3, 2), reference = mottled(24, 18, 3, 1);
    Image bright_image = image, bright_reference = reference;
    for (Rgb& pixel : bright_image.pixels) pixel *= 179;
    for (Rgb& pixel : bright_reference.pixels) pixel *= 179;
    const double distance = perceptual_distance(image, reference, 45);
    EXPECT_GT(distance, 0);
    EXPECT_NEAR(perceptual_distance(bright_image, bright_reference, 45), distance, 1e-6);
}

/// Four copies side by side, with twice the field of view: the frequencies and their shares stay the same.
TEST(PerceptualDistance, DoesNotDependOnTheSizeOfThePicture) {
    const auto four_times = [](const Image& image) {
        Image tiled(2 * image.width, 2 * image.height);
        for (int y = 0; y < tiled.height; ++y)
            for (int x = 0; x < tiled.width; ++x) tiled.at(x, y) = image.at(x % image.width, y % image.height);
        return tiled;
    };
    const Image image = mottled(24, 18, 3, 2), reference = mottled(24, 18, 3, 1);
    EXPECT_NEAR(perceptual_distance(four_times(image), four_times(reference), 4),
                perceptual_distance(image, reference, 2), 1e-6);
}

TEST(PerceptualDistance, RisesWithNoise) {
    double last = 0;
    for (const double amplitude : {0.01, 0.03, 0.1, 0.3, 1.0}) {
        const double distance = perceptual_distance(mottled(64, 36, 2, amplitude), mottled(64, 36, 2, 0), 45);
        EXPECT_GT(distance, 2 * last);
        last = distance;
    }
}

/// Noise of single pixels is visible in a picture of a wide field; in a narrow one the pixels are too fine.
TEST(PerceptualDistance, WhatIsTooFineToSeeDoesNotCount) {
    const Image image = grating(64, 64, 32, 0, 0.1), reference(64, 64, grey_of(1));
    EXPECT_LT(perceptual_distance(image, reference, 0.5), 0.01 * perceptual_distance(image, reference, 4));
}

TEST(PerceptualDistance, OfABlackReference) {
    EXPECT_TRUE(std::isinf(perceptual_distance(Image(3, 2, grey_of(1)), Image(3, 2), 45)));
    EXPECT_EQ(perceptual_distance(Image(3, 2, grey_of(-1)), Image(3, 2), 45), 0) << "less than nothing is black too";
}

TEST(PerceptualDistance, RefusesWhatItCannotCompare) {
    EXPECT_THROW(perceptual_distance(Image(3, 2), Image(2, 3), 45), InputError);
    EXPECT_THROW(perceptual_distance(Image(), Image(), 45), InputError);
    for (const double fov : {0.0, -1.0, 180.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(perceptual_distance(Image(3, 2), Image(3, 2), fov), InputError) << fov;
}

}  // namespace
}  // namespace interflect
