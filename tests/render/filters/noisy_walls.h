#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/render.h"

namespace interflect::testing_support {

using namespace detail;

inline double mean_of(const Image& image) {
    double sum = 0;
    for (const Rgb& pixel : image.pixels) sum += channel_sum(RgbD(pixel)) / 3;
    return sum / static_cast<double>(image.pixels.size());
}

/// A wall, 1 m away and evenly lit, without noise.
inline PictureLayers wall(int side) {
    PictureLayers layers;
    layers.emitted = layers.albedo = layers.normal = layers.position = Image(side, side);
    const auto pixels = layers.albedo.pixels.size();
    for (SampledLight* light : {&layers.reflected, &layers.halves[0], &layers.halves[1]})
        *light = {Image(side, side), Image(side, side), std::vector<float>(pixels), std::vector<float>(pixels)};
    layers.depth.assign(pixels, 1);
    layers.pixel_angle = 0.01f;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            layers.albedo.at(x, y) = Rgb(1);
            layers.normal.at(x, y) = Rgb(0, 0, 1);
            layers.position.at(x, y) = Rgb(static_cast<float>(x), static_cast<float>(y), 0) * 0.01f;
        }
    return layers;
}

/// The left half is in shadow. The reflectance is chequered, the noise 30% / sqrt(3).
inline PictureLayers noisy_wall(int side) {
    PictureLayers layers = wall(side);
    constexpr float noise = 0.3f;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto i = static_cast<std::size_t>(y * side + x);
            const float albedo = (x / 2 + y / 2) % 2 == 0 ? 0.2f : 0.8f, level = x < side / 2 ? 0.1f : 1.0f;
            layers.albedo.pixels[i] = Rgb(albedo);
            for (std::uint32_t h = 0; h < 2; ++h) {
                const float even = 2 * unit_float(random_words(1, i)[h]) - 1;  // variance 1/3; mean of two: 1/6
                const float light = albedo * level * (1 + std::sqrt(2.0f) * noise * even);
                layers.halves[h].direct.pixels[i] = Rgb(light);
                layers.halves[h].direct_variance[i] = albedo * albedo * level * level * noise * noise * 2 / 3;
                layers.reflected.direct.pixels[i] += Rgb(light / 2);
            }
        }
    return layers;
}

/// Direct light of a wall whose halves have a share of bright batches, `brightness` times the others'.
inline PictureLayers wall_with_bright_batches(int side, float share, double dark, double bright) {
    constexpr int batches = 4;  // per half
    PictureLayers layers = wall(side);
    for (std::size_t i = 0; i < layers.albedo.pixels.size(); ++i)
        for (std::size_t h = 0; h < 2; ++h) {
            double mean = 0, mean_square = 0;
            for (std::size_t b = 0; b < batches; ++b) {
                const auto word = random_words(2, (2 * i + h) * batches + b)[0];
                const double light = unit_float(word) < share ? bright : dark;
                mean += light / batches;
                mean_square += light * light / batches;
            }
            layers.halves[h].direct.pixels[i] = Rgb(static_cast<float>(mean));
            layers.halves[h].direct_variance[i] = static_cast<float>((mean_square - mean * mean) / (batches - 1));
        }
    return layers;
}

}  // namespace interflect::testing_support
