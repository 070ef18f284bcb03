// Faces with holes (Material::transmittance_texture).

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/measure.h"
#include "interflect/render.h"
#include "interflect/solution.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/shadings.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// Cuts holes into a material. `open` is the open share at each texel.
void cut_out(Scene& scene, std::uint32_t material, Texture open) {
    Texture there = open;
    for (Rgb& texel : there.texels) texel = Rgb(1) - texel;
    Material& m = scene.materials[material];
    m.transmittance = Rgb(1);
    m.transmittance_texture = static_cast<std::uint32_t>(scene.textures.size());
    m.reflectance_texture = m.exitance_texture = m.transmittance_texture + 1;
    scene.textures.push_back(std::move(open));
    scene.textures.push_back(std::move(there));
}

const Rgb light{60, 50, 40};

/// A room of 2 x 1 x 1 m, divided by two screens with random holes, some of coloured glass. Every surface emits M = (1
/// - rho) B per opaque share, so the radiosity is B everywhere.
Scene divided_furnace() {
    constexpr float rho = 0.6f;
    Scene scene = closed_box({2, 1, 1}, 1, {Material{"wall", Rgb(rho), light * (1 - rho)}});
    const std::uint32_t screen = add_material(scene, Rgb(rho), light * (1 - rho));
    Texture open{"holes", 8, 8, {}};
    for (std::uint64_t i = 0; i < 64; ++i)
        open.texels.push_back(i % 3 == 0 ? Rgb(0.5f, 0.2f, 0.9f) : Rgb(static_cast<float>(mix(i, 7) % 2)));
    cut_out(scene, screen, std::move(open));
    for (const float x : {0.9f, 1.1f}) add_rectangle(scene, {x, 0, 0}, {0, 1, 0}, {0, 0, 1}, screen, 1, 1, true);
    for (const V3f& x : scene.vertices) scene.texture_coordinates.emplace_back(x.y, x.z);
    return scene;
}
const View along{"along", {0.1, 0.5, 0.5}, {2, 0.5, 0.5}, {0, 0, 1}, 40};

class FurnaceWithHoles : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Method, FurnaceWithHoles,
                         testing::Values("srr", "wdrs", "hwdrs", "ihwdrs", "hsrr", "ihsrr", "pr"),
                         [](const auto& tested) { return tested.param; });

/// Seen to fail when rays use the mean of the texture, and when elements reflect the whole reflectance.
TEST_P(FurnaceWithHoles, IsFilledByEveryMethod) {
    RELEASE_ONLY();  // see CutOuts.AreAsTheFacesThatTheyLeave
    const Scene scene = divided_furnace();
    ASSERT_TRUE(scene_faults(scene).empty());
    const RayCaster ray_caster(scene);
    SolveOptions options{.method = find_method(GetParam()), .limits = {.rays = 1'000'000}};
    if (options.method.importance != ImportanceUse::off) options.views = {{along, 1, 1.5f, 48}};
    const Solution solution = solve(scene, ray_caster, options);
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(solution.irradiance[p][c] / light[c], 1, 0.03) << "patch " << p << ", channel " << c;
    EXPECT_NEAR(power_balance(scene, solution).relative_difference(), 0, 0.01);
}

TEST(CutOuts, PicturesOfAFurnaceAreEven) {
    RELEASE_ONLY();  // see CutOuts.AreAsTheFacesThatTheyLeave
    const Scene scene = divided_furnace();
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 500'000}});
    const PictureOptions options{.width = 6, .height = 4, .samples = 1024};
    for (const bool is_gathered : {false, true}) {
        const Rendering picture =
            render(scene, solution, ray_caster, along, by(is_gathered ? Shading::gather : Shading::path, options));
        float errors = 0;
        for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const float expected = light[c] / std::numbers::pi_v<float>;
                const float error = 5 * picture.standard_error.pixels[i][c] + (is_gathered ? 0.01f * expected : 0);
                errors += error / expected / (3.0f * static_cast<float>(picture.image.pixels.size()));
                EXPECT_NEAR(picture.image.pixels[i][c], expected, error);
            }
        EXPECT_LT(errors, 0.15f);  // noisier pixels would be no test
    }
}

/// A lamp of 20 cm over a floor of 4 x 4 patches. Between them is a board whose half x > 2 m is removed, by its texture
/// or as geometry.
Scene half_board(bool is_cut_out) {
    Scene scene;
    add_rectangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 4, 4);
    add_rectangle(scene, {1.9f, 1.9f, 2.9f}, {0, 0.2f, 0}, {0.2f, 0, 0}, add_material(scene, Rgb(0), Rgb(5000)));
    const std::uint32_t board = add_material(scene, Rgb(0.8f), Rgb(0));
    add_rectangle(scene, {0, 0, 1.5f}, {is_cut_out ? 4.0f : 2.0f, 0, 0}, {0, 4, 0}, board, 1, 1, true);
    if (!is_cut_out) return scene;
    constexpr std::uint32_t columns = 1024;  // the edge is blurred over one column, 4 mm
    Texture open{"half", columns, 1, {}};
    for (std::uint32_t i = 0; i < columns; ++i) open.texels.emplace_back(i < columns / 2 ? 0.0f : 1.0f);
    cut_out(scene, board, std::move(open));
    for (const V3f& x : scene.vertices) scene.texture_coordinates.emplace_back(x.x / 4, x.y / 4);
    return scene;
}

/// Seen to fail with the texture mirrored, and when shadow rays use its mean.
TEST(CutOuts, AreAsTheFacesThatTheyLeave) {
    const Scene cut = half_board(true), whole = half_board(false);
    const RayCaster of_cut(cut), of_whole(whole);
    const SolveOptions options{.method = find_method("srr"), .limits = {.rays = is_sanitized ? 200'000 : 2'000'000}};
    const Solution by_texture = solve(cut, of_cut, options), by_face = solve(whole, of_whole, options);
    float brightest = 0;
    for (std::uint32_t p = 0; p < 16; ++p) brightest = std::max(brightest, by_face.irradiance[p].x);
    for (std::uint32_t p = 0; p < 16; ++p)
        EXPECT_NEAR(by_texture.irradiance[p].x, by_face.irradiance[p].x, 0.02f * brightest) << "patch " << p;
    EXPECT_LT(by_face.irradiance[0].x, 0.1f * brightest);

    const std::vector<MeasuringPoint> points{{{0.7, 2, 0}}, {{1.8, 1, 0}}, {{2.3, 2, 0}}, {{3.4, 3, 0}}};
    const auto measured = [&](const Scene& scene, const RayCaster& ray_caster, const Solution* solution) {
        return measure_irradiance(scene, solution, ray_caster, points,
                                  {.shading = solution ? Shading::gather : Shading::path, .samples = 4096});
    };
    for (const bool is_gathered : {false, true}) {
        const auto found = measured(cut, of_cut, is_gathered ? &by_texture : nullptr);
        const auto expected = measured(whole, of_whole, is_gathered ? &by_face : nullptr);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float error = 5 * (found[i].standard_error.x + expected[i].standard_error.x);
            EXPECT_NEAR(found[i].sum().x, expected[i].sum().x, error + 0.01f * brightest) << "point " << i;
        }
    }
}

/// Seen from above: the left half of the board, and the floor through its right half.
TEST(CutOuts, AreSeenThrough) {
    const Scene cut = half_board(true), whole = half_board(false);
    const RayCaster of_cut(cut), of_whole(whole);
    const View down{"down", {2, 2.5, 2.5}, {2, 2.5, 0}, {0, 1, 0}, 40};
    const SolveOptions options{.method = find_method("srr"), .limits = {.rays = 2'000'000}};
    const Solution by_texture = solve(cut, of_cut, options), by_face = solve(whole, of_whole, options);
    const PictureOptions size{.width = 8, .height = 4, .shading = Shading::flat, .samples = 64};
    const Image drawn = render(cut, by_texture, of_cut, down, size).image;
    const Image expected = render(whole, by_face, of_whole, down, size).image;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i)
        EXPECT_NEAR(drawn.pixels[i].x / expected.pixels[i].x, 1, 0.04) << "pixel " << i;
}

}  // namespace
}  // namespace interflect
