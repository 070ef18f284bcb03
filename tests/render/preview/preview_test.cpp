// Quick pictures: light of few pixels, on the surfaces of all.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/preview.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/render/preview/coarse_light.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/textured_scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

struct Lit {
    explicit Lit(Scene s, std::int64_t rays = 200'000)
        : scene(std::move(s)),
          ray_caster(scene),
          solution(solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = rays}})) {}

    Image preview(const View& view, const PictureOptions& options, double reduction) const {
        return interflect::preview(scene, solution, ray_caster, view, options, {reduction, Denoiser::own}).image;
    }
    Image picture(const View& view, PictureOptions options) const {
        options.samples = 64;
        return render(scene, solution, ray_caster, view, options).image;
    }

    Scene scene;
    RayCaster ray_caster;
    Solution solution;
};

double sum_of(const Image& image) {
    double sum = 0;
    for (const Rgb& pixel : image.pixels) sum += static_cast<double>(channel_sum(pixel));
    return sum;
}

/// Root mean square of the differences, relative to that of the reference.
double relative_difference(const Image& image, const Image& reference) {
    double squares = 0, all = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        squares += static_cast<double>((image.pixels[i] - reference.pixels[i]).length2());
        all += static_cast<double>(reference.pixels[i].length2());
    }
    return std::sqrt(squares / all);
}

/// Radiosity is B on all surfaces, although reflectance and exitance vary within a pixel of the smaller picture. Seen
/// to fail without the exitance, with the reflectance of the smaller picture, and without 1 / pi.
TEST(Preview, OfATexturedFurnaceIsUniform) {
    const Rgb radiosity(40, 20, 10);
    const Lit lit(textured_furnace(radiosity));
    for (const int reduction : {1, 3, 8}) {
        const PictureOptions options{.width = 25 * reduction - 1, .height = 17 * reduction};
        const Image image = lit.preview(into_the_corner, options, reduction);
        const double expected = static_cast<double>(channel_sum(radiosity) / std::numbers::pi_v<float>);
        EXPECT_NEAR(sum_of(image) / static_cast<double>(image.pixels.size()) / expected, 1, 0.01) << reduction;
        for (const Rgb& pixel : image.pixels)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(pixel[c] * std::numbers::pi_v<float> / radiosity[c], 1, 0.15) << reduction;
    }
}

struct Quantity {
    std::string name;
    PictureQuantity quantity;
};
void PrintTo(const Quantity& q, std::ostream* out) { *out << q.name; }

class PreviewOfARoom : public testing::TestWithParam<Quantity> {};
INSTANTIATE_TEST_SUITE_P(Quantities, PreviewOfARoom,
                         testing::Values(Quantity{"Radiance", PictureQuantity::radiance},
                                         Quantity{"Irradiance", PictureQuantity::irradiance}),
                         testing::PrintToStringParamName());

/// A box and a screen before walls of several colours.
TEST_P(PreviewOfARoom, IsCloseToThePicture) {
    RELEASE_ONLY();  // see Preview.IsNotShifted
    const Lit lit(furnished_room());
    const PictureOptions options{.width = 160, .height = 90, .quantity = GetParam().quantity};
    const Image reference = lit.picture(into_the_corner, options);
    for (const auto& [reduction, most] : {std::pair{1.5, 0.08}, {2.0, 0.08}, {4.0, 0.12}}) {
        const Image image = lit.preview(into_the_corner, options, reduction);
        EXPECT_LT(relative_difference(image, reference), most) << reduction;
        EXPECT_NEAR(sum_of(image) / sum_of(reference), 1, 0.02) << reduction;
    }
}

/// The centre of the light of a lamp beside a wall; sizes are no multiples of the reduction.
TEST(Preview, IsNotShifted) {
    constexpr int width = 101, height = 61;
    Scene scene = closed_box({4, 3, 2}, 1, {Material{.name = "wall", .reflectance = Rgb(0.3f)}});
    scene.luminaires.push_back({"lamp", 0, PointLight{{3.5f, 1.3f, 0.9f}, Rgb(100)}});
    const Lit lit(std::move(scene));
    const View view{"wall", {0.5, 1.5, 1}, {4, 1.5, 1}, {0, 0, 1}, 40};
    const auto centre = [&](const Image& image) {
        Imath::V2d sum(0);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) sum += Imath::V2d(x, y) * static_cast<double>(image.at(x, y).y);
        return sum * 3 / sum_of(image);
    };
    const PictureOptions options{.width = width, .height = height};
    const Imath::V2d expected = centre(lit.picture(view, options));
    for (const double reduction : {1.5, 2.0, 5.0, 8.0})
        EXPECT_LT((centre(lit.preview(view, options, reduction)) - expected).length(), 0.3) << reduction;
}

/// Two parallel walls, 10 pixels apart, of irradiance 1 and 100: at their common outline, each keeps its light. Seen to
/// fail if pixels of other planes have equal weights, a fault that the pictures of this file tolerate.
TEST(CoarseLight, IsThatOfPixelsInTheSamePlane) {
    constexpr int side = 8;
    constexpr float distance = 10, albedo = 0.5f;
    const V3f normal(0, 0, 1);
    PictureLayers layers;
    layers.emitted = Image(side, side);
    layers.albedo = layers.normal = layers.position = layers.emitted;
    layers.depth.assign(side * side, 1);
    layers.pixel_size = 1;
    Image picture(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const bool is_near = x < side / 2;
            layers.albedo.at(x, y) = Rgb(albedo);
            layers.normal.at(x, y) = Rgb(normal);
            layers.position.at(x, y) = Rgb(static_cast<float>(x), static_cast<float>(y), is_near ? 0 : -distance);
            picture.at(x, y) = Rgb(albedo * (is_near ? 1.0f : 100.0f));
        }
    const detail::CoarseLight light(layers, picture);
    const auto at_outline = [&](float z) { return light.at(side / 2.0f, side / 2.0f, {3.5f, 3.5f, z}, normal)->x; };
    EXPECT_NEAR(at_outline(0), 1, 0.01);
    EXPECT_NEAR(at_outline(-distance), 100, 0.01);
}

/// A pane before a wall, whose light it halves, and a mirror.
TEST(Preview, ShowsWhatIsBehindGlassAndInMirrors) {
    Scene scene = furnished_room();
    const std::uint32_t glass = add_material(scene, Rgb(0.05f), Rgb(0)),
                        mirror = add_material(scene, Rgb(0.1f), Rgb(0));
    scene.materials[glass].transmittance = Rgb(0.5f, 0.6f, 0.7f);
    scene.materials[mirror].specular_reflectance = Rgb(0.8f);
    add_rectangle(scene, {0.1f, 0.8f, 0.4f}, {0.5f, 0, 0}, {0, 0, 0.9f}, glass, 1, 1, true);
    add_rectangle(scene, {0.01f, 0.3f, 0.3f}, {0, 1.2f, 0}, {0, 0, 1.5f}, mirror);
    const Lit lit(std::move(scene));
    const PictureOptions options{.width = 160, .height = 90};
    const Image image = lit.preview(into_the_corner, options, 3);
    RELEASE_ONLY();  // the picture
    const Image reference = lit.picture(into_the_corner, options);
    EXPECT_LT(relative_difference(image, reference), 0.12);
    EXPECT_NEAR(sum_of(image) / sum_of(reference), 1, 0.015);
}

/// A courtyard in the sun, a sheet that throws a shadow on its floor, and a pane. Seen to fail if suns are left to the
/// smaller picture, counted twice, or without the transmittance of the pane.
TEST_P(PreviewOfARoom, HasSharpShadowsOfSuns) {
    RELEASE_ONLY_IF(GetParam().quantity == PictureQuantity::radiance);
    Scene scene = open_colourful_box();
    const std::uint32_t glass = add_material(scene, Rgb(0), Rgb(0)), sheet = add_material(scene, Rgb(0.4f), Rgb(0));
    scene.materials[glass].transmittance = Rgb(0.5f, 0.6f, 0.7f);
    add_rectangle(scene, {0.2f, 0.5f, 1.6f}, {0.3f, 0, 0}, {0, 0.9f, 0}, sheet, 1, 1, true);
    add_rectangle(scene, {0.5f, 0.5f, 1.6f}, {0.4f, 0, 0}, {0, 0.9f, 0}, glass, 1, 1, true);
    DirectionalLight sun{{0.1f, 0.2f, -1}, Rgb(200)};
    sun.diameter = 0.5f;
    scene.luminaires.push_back({"sun", 0, sun});
    const Lit lit(std::move(scene));
    const View view{"down", {0.5, 1, 2.9}, {0.5, 1.2, 0}, {0, 1, 0}, 50};
    const PictureOptions options{.width = 161, .height = 121, .quantity = GetParam().quantity};
    const Image image = lit.preview(view, options, 8);
    RELEASE_ONLY();  // the picture
    const Image reference = lit.picture(view, options);
    const double most = GetParam().quantity == PictureQuantity::radiance ? 0.1 : 0.065;  // 0.163 and 0.074 if blurred
    EXPECT_LT(relative_difference(image, reference), most);
    EXPECT_NEAR(sum_of(image) / sum_of(reference), 1, 0.01);
}

/// The fine outline of a lamp, which the smaller picture cannot resolve.
TEST(Preview, ShowsThinBars) {
    Scene scene = closed_box({2, 2, 2}, 1, {Material{.name = "wall", .reflectance = Rgb(0.5f)}});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(100 * std::numbers::pi_v<float>));
    add_rectangle(scene, {1.5f, 0.98f, 0.2f}, {0, 0, 1.6f}, {0, 0.04f, 0}, lamp);  // faces the camera
    const Lit lit(std::move(scene));
    const View view{"bar", {0.1, 1, 1}, {2, 1, 1}, {0, 0, 1}, 60};
    const Image image = lit.preview(view, {.width = 96, .height = 96}, 8);
    EXPECT_GT(image.at(47, 48).y, 50);  // the bar is 2.4 pixels wide
    EXPECT_LT(image.at(44, 48).y, 20);
    EXPECT_LT(image.at(51, 48).y, 20);
}

TEST(Preview, RefusesAReductionBelow1) {
    const Lit lit(colourful_box(), 1000);
    EXPECT_THROW(lit.preview(into_the_corner, {.width = 16, .height = 9}, 0), InputError);
}

}  // namespace
}  // namespace interflect
