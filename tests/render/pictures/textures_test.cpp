// Textures in pictures: texels at the right positions, and unbiased light.
//
// Seen to fail when shading or the path tracer uses the texel in the middle of the patch, and when a lamp's texel does
// not belong to the sampled point.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "interflect/elements/forest.h"
#include "interflect/generate.h"
#include "interflect/render/render_elements.h"
#include "interflect/solve.h"
#include "tests/support/parameter_names.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/textured_scenes.h"
#include "tests/support/shadings.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

using std::numbers::pi;

std::vector<double> means(const Scene& scene, const View& view, PictureOptions options, int runs) {
    const RayCaster ray_caster(scene);
    std::vector<double> result;
    for (int i = 1; i <= runs; ++i) {
        options.seed = static_cast<std::uint64_t>(i);
        double sum = 0;
        const Image image = render(scene, ray_caster, view, by(Shading::path, options)).image;
        for (const Rgb& pixel : image.pixels) sum += static_cast<double>(channel_sum(pixel)) / 3;
        result.push_back(sum / static_cast<double>(image.pixels.size()));
    }
    return result;
}

TEST(PathTracedTextures, FurnaceIsAsBrightEverywhere) {
    const Scene scene = textured_furnace(Rgb(2, 2, 2));
    const View view{"corner", V3f(0.1f, 0.2f, 0.3f), V3f(0.9f, 1.8f, 2.8f), V3f(0, 0, 1), 80};
    const PictureOptions options{.width = 6, .height = 4, .samples = 64};
    const std::vector<double> seen = means(scene, view, options, 24);
    EXPECT_GT(t_test(seen, 2 / pi), false_alarm);
    EXPECT_LT(t_test(seen, 2.02 / pi), false_alarm);
}

/// A wall of 1 x 1 m with a texture that is a linear ramp: brighter to the right and, more steeply, upwards.
Scene ramp(bool emits) {
    Scene scene;
    scene.objects = {""};
    scene.materials = {{"wall", Rgb(emits ? 0 : 0.01f), Rgb(emits ? 1 : 0)}};
    (emits ? scene.materials[0].exitance_texture : scene.materials[0].reflectance_texture) = 0;
    scene.textures = {{"ramp", 4, 4, {}}};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            scene.textures[0].texels.emplace_back(static_cast<float>(1 + column + 10 * (3 - row)));
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0);  // seen from y < 0
    for (const V3f& x : scene.vertices)
        scene.texture_coordinates.emplace_back(0.125f + 0.75f * x.x, 0.125f + 0.75f * x.z);
    return scene;
}

double ramp_at(int column, int row, int side) { return 1 + 3 * (column + 0.5) / side + 30 * (side - row - 0.5) / side; }

const View in_front{"front", V3f(0.5f, -10, 0.5f), V3f(0.5f, 0, 0.5f), V3f(0, 0, 1),
                    static_cast<float>(2 * std::atan(0.5 / 10) * 180 / pi)};

class Ramp : public testing::TestWithParam<Shading> {};
INSTANTIATE_TEST_SUITE_P(Shadings, Ramp, testing::Values(Shading::flat, Shading::smooth), printed_name);

TEST_P(Ramp, TexelsAreWhereTheyBelong) {
    constexpr int side = 8;
    for (const bool emits : {true, false}) {
        const Scene scene = ramp(emits);
        const ElementForest forest(scene, 1);
        const std::vector<Rgb> irradiance(1, Rgb(emits ? 0 : 100));  // times 0.01
        const PictureOptions options{.width = side, .height = side, .shading = GetParam(), .samples = 64};
        const Rendering picture = render(scene, forest, RayCaster(scene), in_front, irradiance, options);
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column)
                EXPECT_NEAR(pi * static_cast<double>(picture.image.at(column, row).x), ramp_at(column, row, side),
                            0.05);
    }
}

TEST(PathTracedRamp, TexelsAreWhereTheyBelong) {
    constexpr int side = 8;
    const Scene scene = ramp(true);
    const Rendering picture = render(scene, RayCaster(scene), in_front,
                                     {.width = side, .height = side, .shading = Shading::path, .samples = 64});
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            EXPECT_NEAR(pi * static_cast<double>(picture.image.at(column, row).x), ramp_at(column, row, side), 0.05);
}

/// A lamp with a bright and a dark half, close to the floor, so the half of a sampled point matters: as two lamps
/// without texture, but for 0.3% by the interpolation between the two texels. Noise 0.05%.
TEST(PathTracedLamp, IsAsTwoLamps) {
    RELEASE_ONLY();
    const View view{"ceiling", V3f(3, 1, 0.5f), V3f(3.5f, 1, 2), V3f(1, 0, 0), 40};
    const PictureOptions options{.width = 8, .height = 8, .samples = 256};
    const auto mean_of_runs = [&](const Scene& scene) {
        const std::vector<double> seen = means(scene, view, options, 32);
        return std::accumulate(seen.begin(), seen.end(), 0.0) / 32;
    };
    EXPECT_NEAR(mean_of_runs(half_dark_floor(Halves::emit)),
                0.997 * mean_of_runs(half_dark_floor_of_two_patches(Halves::emit)), 0.01);
}

/// Computes the root mean square difference in blocks of 8 x 8 pixels, relative to the mean.
double block_difference(const Image& a, const Image& b) {
    const Image blocks_a = box_downsample(a, 8), blocks_b = box_downsample(b, 8);
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < blocks_a.pixels.size(); ++i) {
        const double x = luminance(RgbD(blocks_a.pixels[i])), y = luminance(RgbD(blocks_b.pixels[i]));
        squares += (x - y) * (x - y);
        sum += y;
    }
    const auto count = static_cast<double>(blocks_a.pixels.size());
    return std::sqrt(squares / count) / (sum / count);
}

/// A random room. The difference is noise and the error of the mesh; wrong texels would exceed it.
TEST(TexturedRoom, IsAsThePathTracerSeesIt) {
    RELEASE_ONLY();
    Scene scene = make_boxes({.boxes = 6, .seed = 3, .texture = true});
    const RayCaster ray_caster(scene);
    const View view = scene.views[0];
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 4'000'000;
    const Solution solution = solve(scene, ray_caster, options);
    const PictureOptions size{.width = 96, .height = 64, .shading = Shading::smooth, .samples = 64};
    const Image reference =
        render(scene, ray_caster, view, {.width = 96, .height = 64, .shading = Shading::path, .samples = 128}).image;
    const auto picture = [&] {
        return render(scene, *solution.forest, ray_caster, view, solution.irradiance, size).image;
    };
    constexpr double tolerance = 0.02;
    EXPECT_LT(block_difference(picture(), reference), tolerance);
    for (Texture& texture : scene.textures) std::reverse(texture.texels.begin(), texture.texels.end());
    EXPECT_GT(block_difference(picture(), reference), 2 * tolerance);
}

}  // namespace
}  // namespace interflect
