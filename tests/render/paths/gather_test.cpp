// Final gathering against path tracing, which uses no solution; and the denoising filter.

#include "interflect/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "interflect/render/reflections/known_light.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/shadings.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

double mean_of(const Image& image) {
    double sum = 0;
    for (const Rgb& pixel : image.pixels) sum += channel_sum(RgbD(pixel)) / 3;
    return sum / static_cast<double>(image.pixels.size());
}

/// A room of 4 x 3 x 2.5 m with a lamp on its ceiling, a spot light, and a block on the floor near a corner.
Scene furnished_room() {
    Scene scene = closed_box({4, 3, 2.5f}, 2, {Material{"", {0.7f, 0.6f, 0.5f}}});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(3000, 2800, 2000));
    const std::uint32_t wood = add_material(scene, {0.5f, 0.35f, 0.2f}, Rgb(0));
    add_rectangle(scene, {1, 1, 2.45f}, {0, 0.8f, 0}, {0.6f, 0, 0}, lamp);
    add_box(scene, {0.1f, 0.1f, 0}, {0.9f, 0.7f, 0.8f}, wood);
    scene.luminaires.push_back({"spot", 0, SpotLight{{3, 2, 2.3f}, {-1, -0.4f, -2}, {300, 300, 200}, 15, 30}});
    return scene;
}
const View into_corner{"corner", {3.6, 2.7, 1.6}, {0.4, 0.3, 0.5}, {0, 0, 1}, 60};

/// The mean agrees within 0.5%. A solution that is 10% brighter raises the indirect light accordingly, but not the
/// direct light.
TEST(Gather, HasTheMeanOfPathTracing) {
    RELEASE_ONLY();
    const Scene scene = furnished_room();
    const RayCaster ray_caster(scene);
    Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 2'000'000}});
    PictureOptions options{.width = 48, .height = 36, .samples = 256};
    const Rendering reference = render(scene, ray_caster, into_corner, by(Shading::path, options));
    options.seed = 2;
    const Rendering gathered = render(scene, solution, ray_caster, into_corner, by(Shading::gather, options));
    EXPECT_NEAR(mean_of(gathered.image) / mean_of(reference.image), 1, 0.005);
    EXPECT_NEAR(mean_of(gathered.layers.reflected.direct) / mean_of(reference.layers.reflected.direct), 1, 0.005);
    EXPECT_EQ(gathered.non_finite_pixels, 0);
    for (Rgb& h : solution.irradiance) h *= 1.1f;
    const Rendering brighter = render(scene, solution, ray_caster, into_corner, by(Shading::gather, options));
    EXPECT_EQ(mean_of(brighter.layers.reflected.direct), mean_of(gathered.layers.reflected.direct));
    EXPECT_GT(mean_of(brighter.layers.reflected.indirect) / mean_of(gathered.layers.reflected.indirect),
              1.07);  // near light is traced, so the ratio is below 1.1
}

/// A lamp close to a corner of undivided walls. A single value per wall is wrong near the corner, so its light is
/// traced. Seen to fail when every element may be gathered, at any distance.
TEST(Gather, TracesPathsInCornersOfACoarseSolution) {
    Scene scene = closed_box({4, 3, 2.5f}, 1, {Material{"", Rgb(0.7f), Rgb(0)}});
    scene.luminaires.push_back({"lamp", 0, PointLight{{0.5f, 0.5f, 0.5f}, Rgb(100)}});
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 100'000}});
    const View view{"corner", {1, 1, 1}, {0, 0, 0}, {0, 0, 1}, 50};
    const PictureOptions options{.width = 32, .height = 24, .samples = 128};
    const Image expected =
        box_downsample(render(scene, ray_caster, view, by(Shading::path, options)).layers.reflected.indirect, 8);
    const Image found = box_downsample(
        render(scene, solution, ray_caster, view, by(Shading::gather, options)).layers.reflected.indirect, 8);
    for (std::size_t i = 0; i < expected.pixels.size(); ++i)
        EXPECT_NEAR(found.pixels[i].x / expected.pixels[i].x, 1, 0.05);
}

/// Bits do not depend on threads or tiles, because pixels have their own sequences.
TEST(Gather, SameSeedSameBits) {
    const Scene scene = furnished_room();
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 100'000}});
    const PictureOptions options{.width = 40, .height = 30, .samples = 16};
    const Rendering a = render(scene, solution, ray_caster, into_corner, by(Shading::gather, options));
    const Rendering b = render(scene, solution, ray_caster, into_corner, by(Shading::gather, options));
    EXPECT_EQ(a.image.pixels, b.image.pixels);
}

/// Two batches of two samples for each pixel, four in hybrid shading, however short the time is; with a long time, all
/// samples.
TEST(PictureOptions, TimeLimitsAllButTwoBatches) {
    const Scene scene = furnished_room();
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 100'000}});
    const auto least = [](const Rendering& p) { return *std::min_element(p.batches.begin(), p.batches.end()); };
    const auto most = [](const Rendering& p) { return *std::max_element(p.batches.begin(), p.batches.end()); };
    for (const Shading shading : {Shading::path, Shading::gather, Shading::hybrid}) {
        constexpr double unreachable = 1e-4;  // error; pixels get all samples
        PictureOptions options{.width = 20,
                               .height = 15,
                               .shading = shading,
                               .samples = 64,
                               .max_samples = 64,
                               .until = unreachable,
                               .time = 1e-9};
        const Rendering shortest = render(scene, solution, ray_caster, into_corner, options);
        EXPECT_EQ(least(shortest), 2u);
        EXPECT_EQ(most(shortest), 2u);
        const unsigned samples = shading == Shading::hybrid ? 4 : 2;
        EXPECT_EQ(shortest.paths, 20 * 15 * 2 * samples);
        EXPECT_FALSE(shortest.interrupted);
        options.time = 1e6;
        const Rendering longest = render(scene, solution, ray_caster, into_corner, options);
        options.time = PictureOptions().time;
        const Rendering unlimited = render(scene, solution, ray_caster, into_corner, options);
        EXPECT_EQ(most(longest), 64 / samples);
        EXPECT_NEAR(mean_of(longest.image) / mean_of(unlimited.image), 1, 0.01);
        options.time = 0;
        EXPECT_THROW(render(scene, solution, ray_caster, into_corner, options), InputError);
    }
}

/// The mean of 1 / density over sampled points is the sampled area: here the bright area in front of the
/// point.
TEST(KnownLight, SamplesWithTheStatedDensity) {
    const Scene scene = closed_box({1, 2, 3}, 2, {Material{"", Rgb(0.5f)}});
    std::vector<PatchGeometry> geometry;
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    ElementForest forest(scene, 1000);
    forest.subdivide(ElementIndex(0));
    forest.subdivide(forest.first_child(ElementIndex(0)) + 2);
    forest.subdivide(ElementIndex(7));
    std::vector<Rgb> irradiance(forest.size(), Rgb(1));
    for (PatchIndex patch(0); patch < forest.patch_count(); patch += 5) irradiance[patch] = Rgb(20);
    const ElementIndex first = forest.first_child(EElementIndex(lementIndex)(7));
    irradiance[first + 1] = Rgb(30);
    irradiance[first + 3] = Rgb(40);
    pull(forest, irradiance);
    KnownLight light(scene, geometry, forest, irradiance);
    light.sample_brighter_than(3);
    std::vector<float> weights(scene.patches.size(), 1);
    weights[5] = 0.7f;
    weights[10] = 1.3f;
    light.weigh(weights);
    const V3f x(0.5f, 1, 0), n(0, 0, 1);
    double in_front = 0;  // area of the bright leaves
    for (const ElementIndex leaf : forest.leaves())
        if (irradiance[leaf].x > 1 && geometry[forest.patch(leaf)].normal().z < 1) in_front += forest.area(leaf);
    constexpr int samples = 200'000;
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
        const auto words = random_words(5, static_cast<std::uint64_t>(i));
        const auto [place, density] =
            light.sample(x, n, unit_float(words[0]), unit_float(words[1]), unit_float(words[2]));
        ASSERT_NE(place.patch, none);
        EXPECT_EQ(light.place(place.patch, geometry[place.patch].point(place.parameters)).leaf, place.leaf);
        EXPECT_FLOAT_EQ(light.density(place, x, n), density);
        const double area = 1 / static_cast<double>(density);
        sum += area;
        squares += area * area;
    }
    const double mean = sum / samples, error = std::sqrt((squares / samples - mean * mean) / samples);
    EXPECT_GT(z_test(mean, in_front, error), false_alarm);
    EXPECT_LT(z_test(mean, 1.02 * in_front, error), false_alarm);
}

TEST(KnownLight, LeavesEvenLightToDirections) {
    const Scene scene = closed_box({1, 2, 3}, 2, {Material{"", Rgb(0.5f)}});
    std::vector<PatchGeometry> geometry;
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    const ElementForest forest(scene, 1000);
    const std::vector<Rgb> irradiance(forest.size(), Rgb(1));
    KnownLight light(scene, geometry, forest, irradiance);
    light.sample_brighter_than(3);
    EXPECT_EQ(light.sample({0.5f, 1, 0}, {0, 0, 1}, 0.5, 0.5f, 0.5f).place.patch, none);
    EXPECT_EQ(light.density({PatchIndex(0), ElementIndex(0), {0.5f, 0.5f}}, {0.5f, 1, 0}, {0, 0, 1}), 0);
}

/// A wall, 1 m away and evenly lit, without noise.
PictureLayers wall(int side) {
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
PictureLayers noisy_wall(int side) {
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

/// Noise falls to less than a third; textures and the border of the shadow remain.
TEST(Denoise, RemovesNoiseAlone) {
    constexpr int side = 64;
    const PictureLayers layers = noisy_wall(side);
    const Image picture = denoise(layers);
    double before = 0, after = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double level = x < side / 2 ? 0.1 : 1.0;
            const auto albedo = static_cast<double>(layers.albedo.at(x, y).x);
            before += std::pow(static_cast<double>(layers.reflected.direct.at(x, y).x) / (albedo * level) - 1, 2);
            after += std::pow(static_cast<double>(picture.at(x, y).x) / (albedo * level) - 1, 2);
        }
    EXPECT_NEAR(std::sqrt(before) / side, 0.3 / std::sqrt(3), 0.01);
    EXPECT_LT(std::sqrt(after), std::sqrt(before) / 3.3);
}

/// Direct light of a wall whose halves have a share of bright batches, `brightness` times the others'.
PictureLayers wall_with_bright_batches(int side, float share, double dark, double bright) {
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

/// The filter moves light and never changes its sum: for skewed noise, for rare light (most pixels are black and have
/// no variance), without variance, and if the weights depend on the values. Seen to fail (-9 to -34% in rare light)
/// when each pixel is a weighted mean of its neighbours.
TEST(Denoise, KeepsTheSumOfAnyLight) {
    constexpr int side = 96;
    const auto expect_same_sum = [](const PictureLayers& layers, const char* what) {
        const double mean = (mean_of(layers.halves[0].direct) + mean_of(layers.halves[1].direct)) / 2;
        EXPECT_NEAR(mean_of(denoise(layers)) / mean, 1, 1e-5) << what;
    };
    expect_same_sum(wall_with_bright_batches(side, 0.05f, 1, 20), "skewed");
    expect_same_sum(wall_with_bright_batches(side, 0.002f, 0, 1000), "rare");
    PictureLayers layers = wall_with_bright_batches(side, 0.05f, 0, 20);
    for (SampledLight& half : layers.halves) std::fill(half.direct_variance.begin(), half.direct_variance.end(), 0.0f);
    expect_same_sum(layers, "no variance");
    layers = wall_with_bright_batches(side, 0.05f, 1, 20);
    layers.halves[1] = layers.halves[0];
    expect_same_sum(layers, "equal halves");
    // A rough surface, on which the tangent planes of two pixels differ
    for (std::size_t i = 0; i < layers.normal.pixels.size(); ++i) {
        const auto words = random_words(5, i);
        layers.normal.pixels[i] = Rgb(V3f(0.5f * unit_float(words[0]), 0.5f * unit_float(words[1]), 1).normalized());
    }
    expect_same_sum(layers, "rough");
}

/// Rare light spreads: its noise falls.
TEST(Denoise, SpreadsRareLight) {
    constexpr int side = 96;
    const PictureLayers layers = wall_with_bright_batches(side, 0.01f, 0, 100);
    const Image picture = denoise(layers);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const float noisy = (layers.halves[0].direct.pixels[i].x + layers.halves[1].direct.pixels[i].x) / 2;
        before += std::pow(static_cast<double>(noisy) - 1, 2);
        after += std::pow(static_cast<double>(picture.pixels[i].x) - 1, 2);
    }
    EXPECT_LT(std::sqrt(after), std::sqrt(before) / 2);
}

/// Pixels without a hit show the sky, which does not spread to adjacent surfaces.
TEST(Denoise, LeavesTheSkyAsItIs) {
    constexpr int side = 32;
    PictureLayers layers = noisy_wall(side);
    const Image before = denoise(layers);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side / 2; ++x) {
            const auto i = static_cast<std::size_t>(y * side + x);
            layers.emitted.pixels[i] = Rgb(50);
            layers.albedo.pixels[i] = layers.normal.pixels[i] = layers.position.pixels[i] = Rgb(0);
            layers.depth[i] = 0;
            for (SampledLight& half : layers.halves) half.direct.pixels[i] = Rgb(half.direct_variance[i] = 0);
        }
    const Image picture = denoise(layers);
    for (int y = 0; y < side; ++y) {
        EXPECT_EQ(picture.at(0, y), Rgb(50));
        EXPECT_NEAR(picture.at(side - 1, y).x / before.at(side - 1, y).x, 1, 0.2);
    }
}

/// Two faces at a right angle, and two parallel faces at different distances, are not blended.
TEST(Denoise, StopsAtEdges) {
    constexpr int side = 32;
    for (const bool is_step : {false, true}) {
        PictureLayers layers = noisy_wall(side);
        const auto light_at = [&](int x, int y) { return layers.albedo.at(x, y) * (x < side / 2 ? 1.0f : 1.1f); };
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const bool is_left = x < side / 2;
                for (SampledLight& half : layers.halves) half.direct.at(x, y) = light_at(x, y);  // within the noise
                if (is_left && is_step) layers.position.at(x, y).z = 0.5f;
                if (is_left && !is_step) layers.normal.at(x, y) = Rgb(1, 0, 0);
            }
        const Image picture = denoise(layers);
        for (int y = 0; y < side; ++y)
            for (const int x : {side / 2 - 1, side / 2})
                EXPECT_NEAR(picture.at(x, y).x / light_at(x, y).x, 1, 0.01) << is_step;
    }
}

}  // namespace
}  // namespace interflect
