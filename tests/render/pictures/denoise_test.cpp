// denoise() does not increase the error of means over blocks of pixels, in six different scenes.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "interflect/denoise.h"
#include "interflect/generate.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

struct Place {
    std::string name;
    Scene scene;
    View view;
};

Place generated(const char* name, Scene scene) {
    const View view = scene.views.front();
    return {name, std::move(scene), view};
}

Place textured_walls() {
    BoxesOptions options;
    options.boxes = 8;
    options.texture = true;
    return generated("textured walls", make_boxes(options));
}

/// A window of 1.5 x 1.2 m in the wall x = 0, between four pieces of wall.
Place sunlit_room() {
    Scene scene;
    const std::uint32_t wall = add_material(scene, {0.7f, 0.65f, 0.6f}, Rgb(0));
    const V3f x(5, 0, 0), y(0, 4, 0), z(0, 0, 2.8f), o(0, 0, 0);
    add_rectangle(scene, o, x, y, wall, 2, 2, true);
    add_rectangle(scene, z, x, y, wall, 2, 2, true);
    add_rectangle(scene, o, x, z, wall, 2, 2, true);
    add_rectangle(scene, y, x, z, wall, 2, 2, true);
    add_rectangle(scene, x, y, z, wall, 2, 2, true);
    add_rectangle(scene, o, y, {0, 0, 0.9f}, wall, 1, 1, true);
    add_rectangle(scene, {0, 0, 2.1f}, y, {0, 0, 0.7f}, wall, 1, 1, true);
    add_rectangle(scene, {0, 0, 0.9f}, {0, 1.2f, 0}, {0, 0, 1.2f}, wall, 1, 1, true);
    add_rectangle(scene, {0, 2.7f, 0.9f}, {0, 1.3f, 0}, {0, 0, 1.2f}, wall, 1, 1, true);
    add_box(scene, {1.5f, 1, 0}, {2.4f, 2, 0.75f}, add_material(scene, {0.5f, 0.35f, 0.2f}, Rgb(0)));
    DirectionalLight sun{{1, 0.3f, -0.8f}, Rgb(40000)};
    sun.diameter = 0.5f;
    scene.luminaires.push_back({"sun", 0, sun});
    scene.luminaires.push_back({"sky", 0, UniformSky{Rgb(2000)}});
    return {"sun through a window", scene, {"to the window", {4.7, 3.7, 1.6}, {0.8, 1, 0.7}, {0, 0, 1}, 60}};
}

/// A hall of 16 x 10 x 5 m with 60 lamps, pillars and crates.
Place hall() {
    Scene scene = closed_box({16, 10, 5}, 2, {Material{"", {0.6f, 0.6f, 0.55f}}});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(9000));
    const std::uint32_t crate = add_material(scene, {0.5f, 0.3f, 0.2f}, Rgb(0));
    for (int i = 0; i < 10; ++i)
        for (int k = 0; k < 6; ++k)
            add_rectangle(scene, {0.8f + 1.5f * static_cast<float>(i), 0.9f + 1.5f * static_cast<float>(k), 4.999f},
                          {0, 0.25f, 0}, {0.25f, 0, 0}, lamp);
    for (int i = 0; i < 4; ++i) {
        const float x = 3 + 3 * static_cast<float>(i);
        add_box(scene, {x, 3, 0.001f}, {x + 0.4f, 3.4f, 4.99f}, crate);
        add_box(scene, {x, 6, 0.001f}, {x + 1, 7, 0.6f + 0.4f * static_cast<float>(i)}, crate);
    }
    return {"hall", scene, {"along", {0.5, 0.6, 1.8}, {12, 7, 0.8}, {0, 0, 1}, 55}};
}

std::vector<Place> places() {
    MazeOptions maze;
    maze.rooms = 1;
    maze.furniture = true;
    return {generated("office", make_office({})),
            generated("maze", make_maze(maze)),
            generated("boxes", make_boxes({})),
            sunlit_room(),
            hall(),
            textured_walls()};
}

constexpr int width = 90, height = 45;  // whole blocks of 5 and of 9

double square_of_blocks(const Image& image, const Image& reference, int block) {
    const Image a = box_downsample(image, block), b = box_downsample(reference, block);
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::pow(channel_sum(RgbD(a.pixels[i] - b.pixels[i])), 2);
    return sum / static_cast<double>(a.pixels.size());
}

Rendering draw(Shading shading, const Place& place, const Solution& solution, const RayCaster& ray_caster, int samples,
               std::uint64_t seed) {
    PictureOptions options{.width = width, .height = height, .shading = shading, .samples = samples, .seed = seed};
    options.until = 1e-9;
    options.max_samples = samples;  // all samples in every pixel
    return render(place.scene, solution, ray_caster, place.view, options);
}

/// Subtracts the light that is not filtered: from lamps, and interpolated.
Image filtered_part(Image image, const PictureLayers& layers) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i] -= layers.emitted.pixels[i];
        if (layers.is_indirect_interpolated) image.pixels[i] -= layers.reflected.indirect.pixels[i];
    }
    return image;
}

constexpr std::array<int, 3> block_sizes{1, 5, 9};
using Ratios = std::array<double, block_sizes.size()>;

/// Returns the ratio of root mean square errors after and before filtering, for each size of blocks.
Ratios error_ratios(Denoiser denoiser, Shading shading, const Place& place, const Solution& solution,
                    const RayCaster& ray_caster) {
    constexpr int few = 8, many = 96;
    constexpr std::uint64_t pictures = 4;
    const Rendering reference = draw(shading, place, solution, ray_caster, many, pictures);
    const Image expected = filtered_part(reference.image, reference.layers);
    Ratios before{}, after{}, ratios{};
    for (std::uint64_t seed = 0; seed < pictures; ++seed) {
        const Rendering noisy = draw(shading, place, solution, ray_caster, few, seed);
        const Image light = filtered_part(noisy.image, noisy.layers);
        const Image filtered = filtered_part(denoise(noisy.layers, denoiser).image, noisy.layers);
        for (std::size_t k = 0; k < block_sizes.size(); ++k) {
            before[k] += square_of_blocks(light, expected, block_sizes[k]);
            after[k] += square_of_blocks(filtered, expected, block_sizes[k]);
        }
    }
    for (std::size_t k = 0; k < block_sizes.size(); ++k) ratios[k] = std::sqrt(after[k] / before[k]);
    return ratios;
}

/// Over six other sets of seeds, the mean ratio of a scene was at most 1.08, so the error grows by less than a tenth.
/// The ratio of one set had a standard deviation of 0.01 to 0.10; the mean over the scenes 0.89 to 1.02, with a
/// standard deviation of 0.014. Correct code fails with a probability of about 1e-3 after a change of its random
/// numbers. Four times the variance gives means of 1.17 to 1.29. The filter before this test gave 1.00, 1.08, 1.21
/// and 1.30: it spread the variance at edges of objects over flat surfaces, and overestimated the variance of hybrid
/// shading.
TEST(Denoise, DoesNotIncreaseTheErrorOfBlocks) {
    constexpr double largest_mean = 1.05, largest = 1.4;
    constexpr std::array<double, 2> largest_mean_of_pixels{0.7, 0.97};  // 0.61 and 0.92; without a filter 1
    const std::vector<Place> all = places();
    std::array<Ratios, 2> squares{};
    constexpr std::array shadings{Shading::gather, Shading::hybrid};
    for (const Place& place : all) {
        const RayCaster ray_caster(place.scene);
        const Solution solution =
            solve(place.scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 500'000}});
        for (std::size_t t = 0; t < shadings.size(); ++t) {
            const Ratios ratios = error_ratios(Denoiser::own, shadings[t], place, solution, ray_caster);
            for (std::size_t k = 0; k < ratios.size(); ++k) {
                EXPECT_LT(ratios[k], largest)
                    << place.name << ", " << label(shadings[t]) << ", blocks of " << block_sizes[k];
                squares[t][k] += ratios[k] * ratios[k];
            }
        }
    }
    for (std::size_t t = 0; t < shadings.size(); ++t)
        for (std::size_t k = 0; k < block_sizes.size(); ++k) {
            const double mean = std::sqrt(squares[t][k] / static_cast<double>(all.size()));
            EXPECT_LT(mean, block_sizes[k] == 1 ? largest_mean_of_pixels[t] : largest_mean)
                << label(shadings[t]) << ", blocks of " << block_sizes[k];
        }
}

}  // namespace
}  // namespace interflect
