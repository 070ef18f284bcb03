// Thin glass and mirrors.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "interflect/measure.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/shadings.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

const Rgb colour{0.8f, 0.5f, 0.25f};

std::uint32_t add_glass(Scene& scene, const Rgb& transmittance, const Rgb& reflectance) {
    const std::uint32_t glass = add_material(scene, reflectance, Rgb(0));
    scene.materials[glass].transmittance = transmittance;
    return glass;
}

/// A room of 2 x 1 x 1 m with two parallel panes across its middle. The panes absorb nothing, so the irradiance is M /
/// (1 - rho) everywhere. The walls are divided at the panes, because hr samples partial visibility with few lines.
Scene divided_furnace() {
    Scene scene;
    const std::uint32_t wall = add_material(scene, {0.5f, 0.6f, 0.4f}, Rgb(30));
    const std::uint32_t glass = add_glass(scene, {0.7f, 0.2f, 1}, {0.3f, 0.8f, 0});
    const V3f y(0, 1, 0), z(0, 0, 1);
    constexpr std::array ends{0.0f, 0.9f, 1.1f, 2.0f};
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const float from = ends[i];
        const V3f x(ends[i + 1] - from, 0, 0);
        add_rectangle(scene, {from, 0, 0}, x, y, wall);
        add_rectangle(scene, {from, 0, 1}, y, x, wall);
        add_rectangle(scene, {from, 0, 0}, z, x, wall);
        add_rectangle(scene, {from, 1, 0}, x, z, wall);
        if (i > 0) add_rectangle(scene, {from, 0, 0}, y, z, glass, 1, 1, true);
    }
    add_rectangle(scene, {0, 0, 0}, y, z, wall);
    add_rectangle(scene, {2, 0, 0}, z, y, wall);
    return scene;
}
const View along{"along", {0.1, 0.5, 0.5}, {2, 0.5, 0.5}, {0, 0, 1}, 40};

class EveryMethod : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Method, EveryMethod, testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const Method& method : methods) names.emplace_back(method.name);
                             return names;
                         }()),
                         [](const auto& tested) {
                             std::string name = tested.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

/// Seen to fail when rays, lines and links pass unfiltered, and when panes filter twice. hr has one element per patch,
/// because its smaller adjacent elements exchange too much.
TEST_P(EveryMethod, FillsAFurnaceThroughGlass) {
    RELEASE_ONLY();
    const Scene scene = divided_furnace();
    const RayCaster ray_caster(scene);
    SolveOptions options{.method = find_method(GetParam()), .limits = {.rays = 1'000'000}};
    options.method.refines = options.method.refines && options.method.is_stochastic;
    if (options.method.importance != ImportanceUse::off) options.views = {{along, 1, 1.5f, 48}};
    if (GetParam() == "global-lines") options.limits.rays *= 4;  // few lines cross the small patches
    const Solution solution = solve(scene, ray_caster, options);
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        for (int c = 0; c < 3; ++c) {
            const float expected = 30 / (1 - scene.materials[0].reflectance[c]);
            EXPECT_NEAR(solution.irradiance[p][c] / expected, 1, 0.03) << "patch " << p << ", channel " << c;
        }
}

/// A pass ends with random walks. A ray that crosses many panes arrives at each of them, and a walk continues from each
/// arrival. Did not end, and filled the memory, while walks survived by the reflectance alone: 28 panes that reflect
/// 10% continued up to 2.8 walks for each one, in addition to those on the walls.
TEST(Glass, ManyPanesInARowDoNotMultiplyWalks) {
    RELEASE_ONLY();  // see Glass.FiltersLightByItsColour
    Scene scene = closed_box({2, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(30)}});
    const std::uint32_t glass = add_glass(scene, Rgb(0.9f), Rgb(0.1f));
    for (int pane = 0; pane < 28; ++pane)
        add_rectangle(scene, {0.97f + 0.002f * static_cast<float>(pane), 0, 0}, {0, 1, 0}, {0, 0, 1}, glass, 1, 1,
                      true);
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 300'000}});
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        EXPECT_NEAR(solution.irradiance[p].x / 60, 1, 0.03) << "patch " << p;
}

TEST(Glass, PicturesOfAFurnaceAreEven) {
    RELEASE_ONLY();  // see Glass.FiltersLightByItsColour
    const Scene scene = divided_furnace();
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 500'000}});
    const PictureOptions options{.width = 6, .height = 4, .samples = 1024};
    RgbD expected;
    for (int c = 0; c < 3; ++c)
        expected[c] = 30 / (1 - static_cast<double>(scene.materials[0].reflectance[c])) / std::numbers::pi;
    for (const bool is_gathered : {false, true}) {
        const Rendering picture =
            render(scene, solution, ray_caster, along, by(is_gathered ? Shading::gather : Shading::path, options));
        double errors = 0;
        for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double error = 5 * static_cast<double>(picture.standard_error.pixels[i][c]);
                errors += error / expected[c] / (3.0 * static_cast<double>(picture.image.pixels.size()));
                EXPECT_NEAR(picture.image.pixels[i][c], expected[c], error + (is_gathered ? 0.01 : 0) * expected[c]);
            }
        EXPECT_LT(errors, is_gathered ? 0.05 : 0.15);  // noisier pixels would be no test
    }
    const Rendering drawn =
        render(scene, solution, ray_caster, along, {.width = 6, .height = 4, .shading = Shading::smooth});
    for (const Rgb& pixel : drawn.image.pixels)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c] / expected[c], 1, 0.04);
}

struct LampBehindGlass {
    Scene scene;
    V3f x{2, 2, 0};

    LampBehindGlass(const Luminaire* luminaire, const Rgb& transmittance) {
        add_rectangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, add_material(scene, Rgb(0), Rgb(0)));
        if (luminaire)
            scene.luminaires.push_back(*luminaire);
        else
            add_rectangle(scene, {1.9f, 1.9f, 2.9f}, {0, 0.2f, 0}, {0.2f, 0, 0},
                          add_material(scene, Rgb(0), Rgb(5000)));
        if (transmittance != Rgb(1))
            add_rectangle(scene, {-2, -2, 1.5f}, {8, 0, 0}, {0, 8, 0}, add_glass(scene, transmittance, Rgb(0)), 1, 1,
                          true);
    }
    MeasuredIrradiance measured(const Solution* solution) const {
        const RayCaster ray_caster(scene);
        return measure_irradiance(scene, solution, ray_caster, std::vector<MeasuringPoint>{{Imath::V3d(x)}},
                                  {.shading = solution ? Shading::gather : Shading::path, .samples = 4096})
            .front();
    }
};

/// The light of lamps, luminaires and the sun on the floor is that without the pane times its transmittance, per
/// channel. Seen to fail when shadow rays pass unfiltered.
TEST(Glass, FiltersLightByItsColour) {
    const Luminaire point{"lamp", 0, PointLight{{2, 2, 2.5f}, Rgb(100)}};
    const Luminaire parallel{"sun", 0, DirectionalLight{{0.2f, 0.1f, -1}, Rgb(100)}};
    for (const Luminaire* luminaire : {static_cast<const Luminaire*>(nullptr), &point, &parallel}) {
        LampBehindGlass clear(luminaire, Rgb(1)), tinted(luminaire, colour);
        const MeasuredIrradiance expected = clear.measured(nullptr), found = tinted.measured(nullptr);
        for (int c = 0; c < 3; ++c) {
            const double error = 5 * static_cast<double>(found.standard_error[c] + expected.standard_error[c]);
            EXPECT_GT(expected.sum()[c], 1);
            EXPECT_NEAR(found.sum()[c], expected.sum()[c] * colour[c], error + 1e-4 * expected.sum()[c]);
        }
        const RayCaster ray_caster(tinted.scene), of_clear(clear.scene);
        const SolveOptions options{.method = find_method("srr"), .limits = {.rays = 400'000}};
        const Solution solution = solve(tinted.scene, ray_caster, options);
        const Solution unfiltered = solve(clear.scene, of_clear, options);
        for (int c = 0; c < 3; ++c)  // patch 0 is the floor
            EXPECT_NEAR(solution.irradiance[0][c] / unfiltered.irradiance[0][c], colour[c], 0.02f * colour[c]);
    }
}

/// A mirror that faces the camera shows the wall behind it, scaled by its reflectance; with --no-mirrors it does not.
// Seen to fail if the distance starts anew behind a pane or in a mirror.
TEST(Depth, IsThatFromTheCameraBehindPanesAndInMirrors) {
    Scene scene;
    const std::uint32_t wall = add_material(scene, Rgb(0.5f), Rgb(1));
    const std::uint32_t mirror = add_material(scene, Rgb(0), Rgb(0));
    scene.materials[mirror].specular_reflectance = Rgb(0.9f);
    const V3f y(0, 4, 0), z(0, 0, 4);
    add_rectangle(scene, {1, -2, -2}, y, z, add_glass(scene, Rgb(0.9f), Rgb(0)), 1, 1, true);
    add_rectangle(scene, {4, -2, -2}, z, y, mirror);  // faces the camera
    add_rectangle(scene, {-3, -2, -2}, y, z, wall);   // 4 m to the mirror, 7 m back
    const View ahead{"ahead", {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1};
    const PictureLayers layers =
        render(scene, RayCaster(scene), ahead, {.width = 1, .height = 1, .shading = Shading::path, .samples = 64})
            .layers;
    EXPECT_NEAR(layers.depth[0], 11, 0.01);
}

TEST(Mirror, ShowsWhatIsBehindTheCamera) {
    Scene scene = closed_box({2, 1, 1}, 1, {Material{"", Rgb(0), Rgb(0)}});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(7));
    const std::uint32_t mirror = add_material(scene, Rgb(0), Rgb(0));
    scene.materials[mirror].specular_reflectance = {0.9f, 0.5f, 0.1f};
    add_rectangle(scene, {1.9f, 0, 0}, {0, 0, 1}, {0, 1, 0}, mirror);
    add_rectangle(scene, {0.05f, 0, 0}, {0, 1, 0}, {0, 0, 1}, lamp);
    const RayCaster ray_caster(scene);
    const View view{"mirror", {1, 0.5, 0.5}, {2, 0.5, 0.5}, {0, 0, 1}, 10};
    PictureOptions options{.width = 4, .height = 4, .samples = 16};
    const Image seen = render(scene, ray_caster, view, by(Shading::path, options)).image;
    for (const Rgb& pixel : seen.pixels)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(pixel[c], scene.materials[mirror].specular_reflectance[c] * 7 / std::numbers::pi_v<float>,
                        1e-4);
    options.mirrors = false;
    for (const Rgb& pixel : render(scene, ray_caster, view, by(Shading::path, options)).image.pixels)
        EXPECT_EQ(pixel, Rgb(0));
}

TEST(Mirror, FacingAnotherEnds) {
    Scene scene = closed_box({2, 1, 1}, 1, {Material{"", Rgb(0), Rgb(1)}});
    scene.materials[0].specular_reflectance = Rgb(0.9f);
    const RayCaster ray_caster(scene);
    const Rendering traced =
        render(scene, ray_caster, along, {.width = 4, .height = 4, .shading = Shading::path, .samples = 16});
    // 1 + s + s^2 + ..., truncated below a thousandth and after 32 mirrors.
    EXPECT_NEAR(traced.image.pixels[5].x * std::numbers::pi_v<float>, (1 - std::pow(0.9, 33)) / (1 - 0.9), 0.01);
}

}  // namespace
}  // namespace interflect
