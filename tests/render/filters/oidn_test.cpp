// Open Image Denoise as a filter. Tests of the library itself need it installed: `scripts/setup denoiser`.

#include "interflect/render/filters/oidn.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <stdexcept>

#include "interflect/core.h"
#include "interflect/denoise.h"
#include "tests/render/filters/noisy_walls.h"

namespace interflect {
namespace {

using namespace testing_support;

std::string message_of(const std::filesystem::path& file) {
    try {
        const Oidn library(file);
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return {};
}

TEST(Oidn, RefusesOtherLibraries) {
    EXPECT_THAT(message_of("libm.so.6"),
                testing::HasSubstr("libm.so.6 is no library of Open Image Denoise 2: it has no "
                                   "function oidnNewDevice"));
    EXPECT_THAT(message_of("/no/such/library.so"), testing::HasSubstr("cannot load /no/such/library.so: "));
}

/// The own filter needs no library.
TEST(Oidn, IsNotNeeded) {
    const PictureLayers layers = noisy_wall(32);
    const DenoisedPicture denoised = denoise(layers, Denoiser::own);
    EXPECT_EQ(denoised.filter, "own");
    EXPECT_EQ(available_denoiser(Denoiser::own), Denoiser::own);
    if (find_oidn().library)
        EXPECT_EQ(available_denoiser(Denoiser::automatic), Denoiser::oidn);
    else
        EXPECT_EQ(denoise(layers).image.pixels, denoised.image.pixels);
}

class WithOidn : public testing::Test {
    void SetUp() override {
        if (!find_oidn().library) GTEST_SKIP() << find_oidn().fault;
    }
};

/// Noise falls to less than a quarter, and the stated error is that of the picture.
TEST_F(WithOidn, RemovesNoise) {
    constexpr int side = 128;
    const PictureLayers layers = noisy_wall(side);
    const DenoisedPicture denoised = denoise(layers, Denoiser::oidn);
    EXPECT_THAT(denoised.filter, testing::StartsWith("Open Image Denoise 2."));
    double before = 0, after = 0, stated = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double level = x < side / 2 ? 0.1 : 1.0,
                         light = level * static_cast<double>(layers.albedo.at(x, y).x);
            before += std::pow(static_cast<double>(layers.reflected.direct.at(x, y).x) / light - 1, 2);
            after += std::pow(static_cast<double>(denoised.image.at(x, y).x) / light - 1, 2);
            stated += std::pow(static_cast<double>(denoised.standard_error.at(x, y).x) / light, 2);
        }
    EXPECT_LT(std::sqrt(after), std::sqrt(before) / 4);
    EXPECT_NEAR(std::sqrt(stated) / side, std::sqrt(after) / side, 0.02);
}

/// The filter darkens skewed noise; the combination keeps its mean within a standard error of the picture.
TEST_F(WithOidn, KeepsTheMeanOfSkewedNoise) {
    constexpr int side = 128;
    const PictureLayers layers = wall_with_bright_batches(side, 0.02f, 1, 50);
    const double expected = (mean_of(layers.halves[0].direct) + mean_of(layers.halves[1].direct)) / 2;
    EXPECT_NEAR(mean_of(denoise(layers, Denoiser::oidn).image) / expected, 1, 0.003);
}

TEST_F(WithOidn, GivesTheSameBitsForAnyNumberOfThreads) {
    const PictureLayers layers = noisy_wall(96);
    std::vector<Image> images;
    for (const std::size_t threads : {1, 2}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        images.push_back(denoise(layers, Denoiser::oidn).image);
    }
    EXPECT_EQ(images[0].pixels, images[1].pixels);
}

TEST_F(WithOidn, LeavesDarknessBlack) {
    const PictureLayers layers = wall(64);
    EXPECT_EQ(denoise(layers, Denoiser::oidn).image.pixels, layers.emitted.pixels);
}

/// Emitters and the sky are not filtered.
TEST_F(WithOidn, LeavesEmittedLight) {
    PictureLayers layers = noisy_wall(32);
    for (std::size_t i = 0; i < 16; ++i) {
        layers.emitted.pixels[i] = Rgb(50);
        layers.albedo.pixels[i] = layers.normal.pixels[i] = Rgb(0);
        layers.depth[i] = 0;
        for (SampledLight* light : {&layers.reflected, &layers.halves[0], &layers.halves[1]})
            light->direct.pixels[i] = Rgb(0);
    }
    const Image picture = denoise(layers, Denoiser::oidn).image;
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(picture.pixels[i], Rgb(50));
}

}  // namespace
}  // namespace interflect
