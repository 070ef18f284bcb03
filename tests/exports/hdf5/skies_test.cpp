// Skies, environment maps and the sun's disc in solution files: they are preserved to the bit, and a run under them
// continues with the same bits.
#include <gtest/gtest.h>

#include "interflect/scene/sky/environment_maps.h"
#include "interflect/solution.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

Scene outdoors() {
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 3, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 2, 2);
    const auto image = image_of(3, 2, {{1, 2, 3}, {0.1f, 0, 7e4f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 3, 0.3f}});
    const auto other = image_of(1, 1, {{5, 5, 5}});
    scene.luminaires = {
        {"sky", 0, SkyDome{{0.1f, -0.2f, 0.3f, -0.4f, 0.5f, 0.6f}, {7, 8, 9}, {0.1f, 0.2f, 1}, {0.3f, 0, 1}, 0.7f}},
        {"map", 0, EnvironmentMap{image, {0, 0.1f, 1}, {1, 0.2f, 0}, {1, 2, 0.3f}}},
        {"sun", 0, DirectionalLight{{1, 2, -3}, {40, 50, 60}, sun_diameter}},
        {"other map", 0, EnvironmentMap{other}},
        {"map again", 0, EnvironmentMap{image, {0, 0, 1}, {0, 1, 0}, {0.5f, 0.5f, 0.5f}}}};
    return scene;
}

SolveOptions few_rays() { return {.method = find_method("hsrr"), .limits = {.rays = 50'000}}; }

TEST(SkiesInASolution, ComeBack) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "outdoors.h5";
    const Scene scene = outdoors();
    write_solution(path, scene, solve(scene, RayCaster(scene), few_rays()));
    const Scene read = read_solution(path).scene;
    ASSERT_EQ(read.luminaires.size(), scene.luminaires.size());
    for (std::size_t i = 0; i < scene.luminaires.size(); ++i) {
        EXPECT_STREQ(kind_name(read.luminaires[i]), kind_name(scene.luminaires[i]));
        EXPECT_EQ(rating(read.luminaires[i]), rating(scene.luminaires[i])) << i;
    }
    const auto &sky = std::get<SkyDome>(scene.luminaires[0].kind),
               &sky_read = std::get<SkyDome>(read.luminaires[0].kind);
    EXPECT_EQ(sky_read.model.relative_luminance(0.7, 0.4), sky.model.relative_luminance(0.7, 0.4));
    EXPECT_EQ(sky_read.zenith, sky.zenith);
    EXPECT_EQ(sky_read.sun, sky.sun);
    EXPECT_EQ(sky_read.ground, sky.ground);
    EXPECT_EQ(std::get<DirectionalLight>(read.luminaires[2].kind).diameter, sun_diameter);
    const auto maps = environment_maps(read), written = environment_maps(scene);
    ASSERT_EQ(maps.size(), 2u) << "two luminaires share an image";
    for (std::size_t i = 0; i < maps.size(); ++i) {
        EXPECT_EQ(maps[i]->width, written[i]->width);
        EXPECT_EQ(maps[i]->texels, written[i]->texels);
    }
    const auto &map = std::get<EnvironmentMap>(scene.luminaires[1].kind),
               &map_read = std::get<EnvironmentMap>(read.luminaires[1].kind);
    EXPECT_EQ(map_read.zenith, map.zenith);
    EXPECT_EQ(map_read.north, map.north);
}

TEST(SkiesInARun, GoOnWithTheSameBits) {
    RELEASE_ONLY();  // see SkiesInASolution.ComeBack and SavedTargets.OfTheSkyAreRestored
    const TemporaryFolder folder;
    const auto path = folder.path() / "run.h5";
    Solver whole(outdoors(), few_rays());
    whole.advance({.rays = 20'000});
    whole.save(path);
    Solver opened = Solver::open(path);
    whole.advance({.rays = 20'000});
    opened.advance({.rays = 20'000});
    EXPECT_EQ(whole.solution().irradiance, opened.solution().irradiance);
}

}  // namespace
}  // namespace interflect
