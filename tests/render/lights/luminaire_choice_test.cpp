// The mean light of sampled luminaires equals the sum over all, and many cost hardly more than a few.

#include "interflect/render/lights/luminaire_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

LightSample sample_of(std::uint64_t seed, std::uint64_t i) {
    const auto a = random_words(seed, i), b = random_words(~seed, i);
    return {(a[0] + 0.5) * 0x1p-32, unit_float(a[1]), unit_float(a[2]), unit_float(b[0])};
}

/// The photometry of a downlight with a narrow beam, or of an uplight on a table whose pole is horizontal.
std::shared_ptr<PhotometricWeb> web(PhotometricWeb::Pole pole, std::vector<float> polar, std::vector<float> azimuth,
                                    std::vector<float> intensities, const V3f& opening) {
    auto result = std::make_shared<PhotometricWeb>();
    result->pole = pole;
    result->polar = std::move(polar);
    result->azimuth = std::move(azimuth);
    result->intensities = std::move(intensities);
    result->opening.size = opening;
    return result;
}

/// Luminaires of every kind, turned and tilted, some of them dark at most points.
Scene many_luminaires() {
    Scene scene = closed_box({9, 7, 3}, 1, {Material{"", Rgb(0.5f), Rgb(0)}});
    const auto beam = web(PhotometricWeb::Pole::nadir, {0, 10, 30, 180}, {0, 180, 360},
                          {900, 700, 20, 0, 900, 500, 0, 0, 900, 700, 20, 0}, {0.3f, 0.2f, 0});
    const auto sideways =
        web(PhotometricWeb::Pole::c90, {0, 45, 90, 135, 180}, {-180, -90, 0, 90, 180},
            {0, 10, 50, 10, 0, 0, 0, 0, 0, 0, 5, 80, 300, 80, 5, 0, 0, 20, 0, 0, 0, 10, 50, 10, 0}, {0, 0, 0});
    for (std::uint64_t i = 0; i < 60; ++i) {
        const auto a = random_words(7, i), b = random_words(8, i);
        const V3f p(9 * unit_float(a[0]), 7 * unit_float(a[1]), 3 * unit_float(a[2]));
        const V3f d(unit_float(b[0]) - 0.5f, unit_float(b[1]) - 0.5f, unit_float(b[2]) - 0.7f);
        const Rgb strength(100 * unit_float(a[3]), 50, 100 * unit_float(b[3]));
        if (i % 4 == 0) scene.luminaires.push_back({"", 0, PointLight{p, strength}});
        if (i % 4 == 1) scene.luminaires.push_back({"", 0, SpotLight{p, d, strength, 10, i % 8 == 1 ? 40.0f : 170.0f}});
        if (i % 4 == 2)
            scene.luminaires.push_back({"", 0, MeasuredLight{beam, p, d, {1, 0.1f, 0}, false, strength / 99}});
        if (i % 4 == 3) scene.luminaires.push_back({"", 0, MeasuredLight{sideways, p, d, {1, 0.1f, 0}, true, Rgb(1)}});
    }
    scene.luminaires.push_back({"sun", 0, DirectionalLight{{1, 2, -3}, Rgb(30)}});
    scene.luminaires.push_back({"dusk", 0, DirectionalLight{{0.5f, 0.3f, -0.1f}, Rgb(3, 2, 1)}});
    return scene;
}

/// Seen to fail with cones that are too narrow (acos of half the share), without the probability of a candidate, and
/// when a candidate always replaces the previous one.
TEST(LuminaireChoice, BringsWhatAllLuminairesBring) {
    RELEASE_ONLY();
    const Scene scene = many_luminaires();
    const LuminaireChoice choice(scene);
    for (std::uint64_t k = 0; k < 12; ++k) {
        const auto a = random_words(9, k), b = random_words(10, k);
        const V3f x(9 * unit_float(a[0]), 7 * unit_float(a[1]), 3 * unit_float(a[2]));
        const V3f n = V3f(unit_float(b[0]) - 0.5f, unit_float(b[1]) - 0.5f, unit_float(b[2]) - 0.5f).normalized();
        double sum = 0, difference = 0, squares = 0;
        constexpr int samples = 40'000;
        for (int i = 0; i < samples; ++i) {
            const LightSample sample = sample_of(k, static_cast<std::uint64_t>(i));
            double all = 0;
            for (const Luminaire& l : scene.luminaires) {
                const Illumination light = illumination(l, x, sample.u, sample.v);
                all += channel_sum(light.irradiance) * static_cast<double>(std::max(0.0f, n.dot(light.towards)));
            }
            const double d = channel_sum(choice.choose_lamp(x, n, sample).light.irradiance) +
                             channel_sum(choice.choose_sun(x, n, sample).light.irradiance) - all;
            sum += all;
            difference += d;
            squares += d * d;
        }
        const double error = std::hypot(std::sqrt(squares) / samples, 1e-6 * sum / samples);  // including rounding
        EXPECT_GT(z_test(difference / samples, 0, error), false_alarm) << k;
        EXPECT_LT(error, 0.05 * sum / samples) << k;
    }
}

/// A few luminaires are all candidates, so the choice adds almost no noise.
TEST(LuminaireChoice, AmongAFewIsExact) {
    Scene scene = closed_box({4, 3, 3}, 1, {Material{"", Rgb(0.5f), Rgb(0)}});
    scene.luminaires.push_back({"", 0, PointLight{{1, 1, 2.5f}, Rgb(100)}});
    const LuminaireChoice choice(scene);
    const V3f x(2, 1, 0), n(0, 0, 1);
    const Illumination exact = illumination(scene.luminaires[0], x);
    for (std::uint64_t i = 0; i < 100; ++i)
        EXPECT_FLOAT_EQ(choice.choose_lamp(x, n, sample_of(1, i)).light.irradiance.x,
                        exact.irradiance.x * exact.towards.z);
    EXPECT_EQ(LuminaireChoice(Scene()).choose_lamp(x, n, sample_of(1, 1)).light.irradiance, Rgb(0));
}

}  // namespace
}  // namespace interflect
