// The combination of noisy and filtered light, for filters with known faults.

#include "interflect/render/filters/combine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/render/filters/noisy_walls.h"
#include "tests/support/release_only.h"

namespace interflect {
namespace {

using namespace testing_support;

constexpr int side = 256;
constexpr float noise = 0.3f;  // standard deviation of a half

/// Halves of a wall with the radiance 1 and independent noise.
std::array<Image, 2> noisy_halves(std::uint64_t seed) {
    std::array<Image, 2> halves{Image(side, side), Image(side, side)};
    for (std::size_t i = 0; i < halves[0].pixels.size(); ++i) {
        const auto words = random_words(seed, i);
        for (std::size_t h = 0; h < 2; ++h)
            halves[h].pixels[i] = Rgb(1 + noise * std::sqrt(12.0f) * (unit_float(words[h]) - 0.5f));
    }
    return halves;
}

/// Root mean square difference from 1 in columns [begin, end).
double error(const Image& image, int begin = 0, int end = side) {
    double sum = 0;
    for (int y = 0; y < side; ++y)
        for (int x = begin; x < end; ++x) sum += std::pow(static_cast<double>(image.at(x, y).x) - 1, 2);
    return std::sqrt(sum / (side * (end - begin)));
}

double mean(const Image& image, int begin = 0, int end = side) {
    double sum = 0;
    for (int y = 0; y < side; ++y)
        for (int x = begin; x < end; ++x) sum += static_cast<double>(image.at(x, y).x);
    return sum / (side * (end - begin));
}

/// Root mean square of the stated error.
double stated_error(const CombinedLight& light, int begin = 0, int end = side) {
    return std::sqrt(mean(light.squared_error, begin, end));
}

CombinedLight combined(const std::array<Image, 2>& noisy, const std::function<float(int x, int y)>& filter) {
    std::array<Image, 2> filtered{Image(side, side), Image(side, side)};
    for (Image& image : filtered)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) image.at(x, y) = Rgb(filter(x, y));
    return combine(Surfaces(wall(side)), wall(side).albedo, noisy, filtered);
}

/// A perfect filter is kept: the error falls to a tenth, that of the means that are returned. The mean is that of the
/// noisy light.
TEST(Combine, KeepsAPerfectFilter) {
    const std::array<Image, 2> noisy = noisy_halves(1);
    const CombinedLight light = combined(noisy, [](int, int) { return 1.0f; });
    EXPECT_LT(error(light.light), 0.1 * noise / std::sqrt(2.0));
    EXPECT_NEAR(mean(light.light), (mean(noisy[0]) + mean(noisy[1])) / 2, 5e-4);
}

/// A filter that returns what it is given leaves all noise, and the error of noise is stated.
TEST(Combine, StatesTheErrorOfNoise) {
    const std::array<Image, 2> noisy = noisy_halves(2);
    const CombinedLight light = combine(Surfaces(wall(side)), wall(side).albedo, noisy, noisy);
    const double expected = noise / std::sqrt(2.0);
    EXPECT_NEAR(error(light.light), expected, 0.02 * expected);
    EXPECT_NEAR(stated_error(light), expected, 0.02 * expected);
}

/// A filter that adds a tenth in a region is corrected there. A difference of a tenth is a third of the noise of a
/// pixel, and above that of a few pixels' mean.
TEST(Combine, CorrectsAWrongRegion) {
    constexpr int begin = 64, end = 160;
    const std::array<Image, 2> noisy = noisy_halves(3);
    const auto is_wrong = [](int x, int y) { return x >= begin && x < end && y >= begin && y < end; };
    const CombinedLight light = combined(noisy, [&](int x, int y) { return is_wrong(x, y) ? 1.1f : 1.0f; });
    double sum = 0, inside = 0;
    for (int y = begin; y < end; ++y)
        for (int x = begin; x < end; ++x) {
            sum += static_cast<double>(light.light.at(x, y).x);
            ++inside;
        }
    EXPECT_NEAR(sum / inside, 1, 0.02);
    EXPECT_LT(error(light.light), 0.05);
}

/// The error is below that of the noisy light for a filter without any use, and the stated error agrees with the true
/// one.
TEST(Combine, IsNeverWorseThanTheNoisyLight) {
    RELEASE_ONLY();  // see Combine.CorrectsAWrongRegion
    for (const float period : {2.0f, 8.0f, 32.0f, 128.0f})
        for (const float fault : {0.05f, 0.2f, 1.0f}) {
            const std::array<Image, 2> noisy = noisy_halves(4);
            const CombinedLight light = combined(noisy, [&](int x, int y) {
                return 1 + fault * std::sin(2 * 3.14159265f * static_cast<float>(x) / period) *
                               std::cos(2 * 3.14159265f * static_cast<float>(y) / period);
            });
            const double before = noise / std::sqrt(2.0), after = error(light.light);
            EXPECT_LT(after, 1.02 * before) << "period " << period << ", fault " << fault;
            EXPECT_NEAR(stated_error(light), after, 0.1 * before) << "period " << period << ", fault " << fault;
        }
}

/// Light of one surface does not correct another. The left half is 100 times as bright, and its filter is wrong.
TEST(Combine, StopsAtEdges) {
    std::array<Image, 2> noisy = noisy_halves(5), filtered{Image(side, side), Image(side, side)};
    PictureLayers layers = wall(side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const bool is_left = x < side / 2;
            for (std::size_t h = 0; h < 2; ++h) {
                if (is_left) noisy[h].at(x, y) *= 100;
                filtered[h].at(x, y) = Rgb(is_left ? 130 : 1);
            }
            if (is_left) layers.normal.at(x, y) = Rgb(1, 0, 0);
        }
    const CombinedLight light = combine(Surfaces(layers), layers.albedo, noisy, filtered);
    EXPECT_NEAR(mean(light.light, 0, side / 2), 100, 1);
    EXPECT_LT(error(light.light, side / 2), 0.05);
}

}  // namespace
}  // namespace interflect
