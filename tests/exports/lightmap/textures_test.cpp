// Textures and lightmap coordinates in solution files: a textured scene is preserved, and a run in it continues with
// the same bits.
//
// Seen to fail when coordinates of either kind are left out, and when the means of elements are not recomputed after a
// file is opened.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/mesh/opacity.h"
#include "interflect/solution.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/textured_scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

SolveOptions refining() {
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 200'000;
    return options;
}

TEST(TexturedSolution, ComesBack) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "textured.h5";
    Scene scene = textured_furnace(Rgb(2, 1, 3));
    scene.materials[0].transmittance = Rgb(0.01f);
    scene.materials[0].transmittance_texture = 1;
    write_solution(path, scene, solve(scene, RayCaster(scene), refining()));
    const Scene read = read_solution(path).scene;
    EXPECT_EQ(read.texture_coordinates, scene.texture_coordinates);
    ASSERT_EQ(read.textures.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read.textures[i].name, scene.textures[i].name);
        EXPECT_EQ(read.textures[i].width, scene.textures[i].width);
        EXPECT_EQ(read.textures[i].texels, scene.textures[i].texels);
    }
    EXPECT_EQ(read.materials[0].reflectance_texture, 0u);
    EXPECT_EQ(read.materials[0].exitance_texture, 1u);
    EXPECT_EQ(read.materials[0].transmittance_texture, 1u);
}

TEST(LightmapCoordinates, ComeBackWithThoseThatAreMissing) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "laid-out.h5";
    Scene scene = textured_furnace(Rgb(2, 1, 3));
    const Solution solution = solve(scene, RayCaster(scene), refining());
    write_solution(path, scene, solution);
    EXPECT_TRUE(read_solution(path).scene.lightmap_coordinates.empty());

    const Patch last = scene.patches.back();
    for (const V3f& x : scene.vertices) scene.lightmap_coordinates.emplace_back(x.x, x.y / 2);
    for (const std::uint32_t v : last.vertices) scene.vertices.push_back(scene.vertices[v]);
    for (std::uint32_t k = 0; k < 4; ++k) {
        scene.patches.back().vertices[k] = static_cast<std::uint32_t>(scene.lightmap_coordinates.size());
        scene.texture_coordinates.push_back(scene.texture_coordinates[last.vertices[k]]);
        scene.lightmap_coordinates.emplace_back(std::numeric_limits<float>::quiet_NaN());
    }
    write_solution(path, scene, solution);
    const std::vector<V2f> read = read_solution(path).scene.lightmap_coordinates;
    ASSERT_EQ(read.size(), scene.vertices.size());
    for (std::size_t i = 0; i + 4 < read.size(); ++i) EXPECT_EQ(read[i], scene.lightmap_coordinates[i]) << i;
    for (std::size_t i = read.size() - 4; i < read.size(); ++i) EXPECT_TRUE(std::isnan(read[i].x)) << i;
}

/// Other renderers multiply reflectance by opacity, which is already included in that of a Scene. Seen to fail when the
/// export does not divide by it, and with black holes, which darken the texels around them by interpolation.
TEST(Opacity, IsDividedOutOfTheReflectance) {
    Scene scene;
    scene.textures = {{"reflectance", 3, 1, {Rgb(0.25f), Rgb(0), Rgb(0.75f)}},
                      {"open", 3, 1, {Rgb(0.5f), Rgb(1), Rgb(0)}}};
    Material leaf{.name = "leaf", .reflectance = Rgb(0.9f), .reflectance_texture = 0};
    leaf.transmittance = Rgb(1);
    leaf.transmittance_texture = 1;
    const Texture opacity = opacity_of(scene, leaf);
    EXPECT_EQ(opacity.texels, (std::vector<Rgb>{Rgb(0.5f), Rgb(0), Rgb(1)}));
    EXPECT_FALSE(is_mask(opacity));
    const std::vector<Rgb> expected{Rgb(0.5f), Rgb(0.625f), Rgb(0.75f)};
    const std::vector<Rgb> found = opaque_reflectance(scene, leaf, opacity).texels;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.at(i).x, expected[i].x, 1e-6f);
}

TEST(TexturedSolution, OfAFaultySceneIsNotWritten) {
    const TemporaryFolder folder;
    Scene scene = textured_furnace(Rgb(2, 1, 3));
    const Solution solution = solve(scene, RayCaster(scene), refining());
    scene.textures[1].texels.pop_back();
    EXPECT_THROW(write_solution(folder.path() / "textured.h5", scene, solution), std::runtime_error);
}

TEST(TexturedRun, GoesOnWithTheSameBits) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "run.h5";
    const Scene scene = half_dark_floor(Halves::reflect);
    Solver whole(scene, refining());
    whole.advance({.rays = 100'000});
    whole.save(path);
    Solver opened = Solver::open(path);
    whole.advance({.rays = 100'000});
    opened.advance({.rays = 100'000});
    ASSERT_GT(whole.solution().forest->size(), scene.patches.size()) << "there are elements with means of their own";
    EXPECT_EQ(whole.solution().irradiance, opened.solution().irradiance);
}

}  // namespace
}  // namespace interflect
