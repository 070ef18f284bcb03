// Round trips: scenes through write_mgf() and read_mgf(), views through their list.
#include "interflect/formats/mgf/write_mgf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/formats/build/colour.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/formats/view_files.h"
#include "interflect/generate.h"
#include "interflect/load.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::TemporaryFolder;

std::string mgf_of(const Scene& scene) {
    std::ostringstream out;
    write_mgf(scene, out);
    return out.str();
}

Scene there_and_back(const Scene& scene) { return read_mgf_text(mgf_of(scene), "written.mgf"); }

constexpr float colour_error = 1e-6f;  // guaranteed, relative to the largest channel

void expect_colour(const Rgb& actual, const Rgb& expected, const std::string& what) {
    const Rgb difference = actual - expected;
    const float error = std::max({std::abs(difference.x), std::abs(difference.y), std::abs(difference.z)});
    EXPECT_LE(error, colour_error * largest_channel(expected)) << what << ": " << actual << ", not " << expected;
}

const Material& material_of(const Scene& scene, const Patch& patch) { return scene.materials[patch.material]; }

/// Expects the same patches in the same order at identical positions.
void expect_same_scene(const Scene& actual, const Scene& expected) {
    ASSERT_EQ(actual.patches.size(), expected.patches.size());
    for (std::size_t i = 0; i < expected.patches.size(); ++i) {
        const Patch &a = actual.patches[i], &b = expected.patches[i];
        ASSERT_EQ(a.vertex_count(), b.vertex_count()) << "patch " << i;
        for (int k = 0; k < b.vertex_count(); ++k)
            ASSERT_EQ(actual.vertices[a.vertices[k]], expected.vertices[b.vertices[k]]) << "patch " << i;
        ASSERT_EQ(a.other_side, b.other_side) << "patch " << i;
        ASSERT_EQ(actual.objects[a.object], expected.objects[b.object]) << "patch " << i;
        const Material &m = material_of(actual, a), &n = material_of(expected, b);
        ASSERT_EQ(m.name, n.name) << "patch " << i;
        expect_colour(m.reflectance, n.reflectance, m.name);
        expect_colour(m.exitance, n.exitance, m.name);
    }
    EXPECT_TRUE(actual.warnings.entries().empty());
}

void add_triangle(Scene& scene, std::uint32_t material, const V3f& at, bool two_sided = false) {
    const auto v = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.insert(scene.vertices.end(), {at, at + V3f(1, 0, 0), at + V3f(0, 1, 0.25f)});
    const PatchIndex patch(scene.patches.size());
    scene.patches.push_back({.vertices = {v, v + 1, v + 2, none}, .material = material});
    if (!two_sided) return;
    scene.patches.back().other_side = patch + 1;
    scene.patches.push_back({.vertices = {v, v + 2, v + 1, none}, .material = material, .other_side = patch});
}

Scene scene_of(std::vector<Material> materials) {
    Scene scene;
    scene.objects = {""};
    scene.materials = std::move(materials);
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i)
        add_triangle(scene, i, V3f(2 * static_cast<float>(i), 0, 0));
    return scene;
}

// ---- Whole scenes

TEST(WriteMgf, KeepsLights) {
    Scene scene = read_mgf_text(
        "v a =\n p 0 0 0\nv b =\n p 1 0 0\nv d =\n p 1 1 0\nf a b d\n"
        "o lamps\nc warm =\n cct 2700\nxf -t 0 0 2 -rx 180\nv s =\n p 1 2 3\n n 0 0 1\n"
        "light point a 5\nlight spot s 80 10 30.5\nlight directional s 1000\nxf\no\nlight sky 400\n",
        "lights.mgf");
    ASSERT_EQ(scene.luminaires.size(), 4u);
    const auto& spot = std::get<SpotLight>(scene.luminaires[1].kind);
    EXPECT_LT((spot.position - V3f(1, -2, -5)).length(), 1e-5f);  // moved up, then turned over
    EXPECT_LT((spot.direction - V3f(0, 0, -1)).length(), 1e-6f);
    EXPECT_NEAR(luminance(spot.intensity), 80, 1e-4);
    EXPECT_GT(spot.intensity.x, 2 * spot.intensity.z);
    EXPECT_EQ(scene.objects[scene.luminaires[2].object], "lamps");
    const Scene written = there_and_back(scene);
    ASSERT_EQ(written.luminaires.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_STREQ(kind_name(written.luminaires[i]), kind_name(scene.luminaires[i]));
        EXPECT_EQ(written.objects[written.luminaires[i].object], scene.objects[scene.luminaires[i].object]);
        expect_colour(rating(written.luminaires[i]), rating(scene.luminaires[i]), scene.luminaires[i].name);
    }
    const auto& back = std::get<SpotLight>(written.luminaires[1].kind);
    EXPECT_EQ(back.position, spot.position);
    EXPECT_LT((back.direction - spot.direction).length(), 1e-6f);
    EXPECT_EQ(back.outer_angle, 30.5f);
    EXPECT_EQ(std::get<PointLight>(written.luminaires[0].kind).position,
              std::get<PointLight>(scene.luminaires[0].kind).position);
}

TEST(WriteMgf, FurnishedMaze) {
    const Scene maze = make_maze({.rooms = 6, .furniture = true});
    const Scene read = there_and_back(maze);
    expect_same_scene(read, maze);
    EXPECT_EQ(read.vertices.size(), maze.vertices.size()) << "vertices are shared as they were";
}

TEST(WriteMgf, Offices) {
    const Scene office = make_office({.rooms = 2});
    expect_same_scene(there_and_back(office), office);
}

TEST(WriteMgf, WhatWasReadFromAFile) {
    // Two-sided faces, triangles, nested objects, includes.
    Scene office = read_mgf(testing_support::repository() / "scenes/office.mgf");
    ASSERT_GT(std::count_if(office.patches.begin(), office.patches.end(),
                            [](const Patch& patch) { return patch.other_side != none; }),
              0);
    office.warnings = {};
    expect_same_scene(there_and_back(office), office);
}

TEST(WriteMgf, IsStableFromThenOn) {
    const std::string once = mgf_of(there_and_back(make_maze({.rooms = 3, .furniture = true})));
    EXPECT_TRUE(mgf_of(read_mgf_text(once, "written.mgf")) == once);
}

// ---- Positions

TEST(WriteMgf, PositionsComeBackToTheBit) {
    Scene scene = scene_of({{.name = "grey", .reflectance = {.5f, .5f, .5f}}});
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const auto words = random_words(1, i);
        const float scale = std::ldexp(1.f, static_cast<int>(words[3] % 24) - 12);
        add_triangle(scene, 0, scale * V3f(unit_float(words[0]), -unit_float(words[1]), unit_float(words[2])));
    }
    expect_same_scene(there_and_back(scene), scene);
}

// ---- Materials

TEST(WriteMgf, ColoursComeBack) {
    std::vector<Material> materials;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        const auto words = random_words(2, i), more = random_words(3, i);
        const Rgb colour(unit_float(words[0]), unit_float(words[1]), unit_float(words[2]));
        const Rgb light(unit_float(more[0]), unit_float(more[1]), unit_float(more[2]));
        materials.push_back({.name = "m" + std::to_string(i),
                             .reflectance = 0.99f * colour,
                             .exitance = std::ldexp(1.f, static_cast<int>(words[3] % 40) - 20) * light});
    }
    const Scene scene = scene_of(materials);
    expect_same_scene(there_and_back(scene), scene);
}

TEST(WriteMgf, ColoursAtTheEdge) {
    const Scene scene = scene_of({{.name = "black"},
                                  {.name = "white", .reflectance = {.99f, .99f, .99f}},
                                  {.name = "red", .reflectance = {.9f, 0, 0}, .exitance = {0, 0, 1e5f}},
                                  {.name = "green", .reflectance = {0, .9f, 0}, .exitance = {2e-6f, 0, 0}},
                                  {.name = "blue", .reflectance = {0, 0, .9f}, .exitance = {0, 5e9f, 0}},
                                  {.name = "yellow", .reflectance = {.99f, .99f, 0}},
                                  {.name = "dark", .reflectance = {1e-7f, 3e-7f, 2e-7f}}});
    expect_same_scene(there_and_back(scene), scene);
}

TEST(WriteMgf, ReflectanceAboveTheReadersBoundIsReduced) {
    const Scene read = there_and_back(scene_of({{.name = "bright", .reflectance = {.999f, .999f, .999f}}}));
    expect_colour(read.materials[0].reflectance, Rgb(.99f), "bright");
}

TEST(WriteMgf, OneMaterialOnFacesOfOneAndTwoSides) {
    Scene scene = scene_of({{.name = "paint", .reflectance = {.5f, .4f, .3f}}, {.name = "other"}});
    for (int i = 0; i < 4; ++i)
        add_triangle(scene, static_cast<std::uint32_t>(i / 2), V3f(0, static_cast<float>(i), 2), i % 2 == 0);
    const Scene read = there_and_back(scene);
    expect_same_scene(read, scene);
    EXPECT_EQ(read.materials.size(), 2u);
}

TEST(WriteMgf, MaterialsOfOneNameOrNone) {
    const Rgb grey(.5f), white(.8f);
    Scene scene = scene_of({{.name = "paint", .reflectance = grey},
                            {.name = "paint", .reflectance = white},
                            {.name = "", .reflectance = grey},
                            {.name = "", .reflectance = white}});
    for (const std::uint32_t material : {0u, 1u, 2u, 2u, 3u, 2u, 0u, 0u, 1u})
        add_triangle(scene, material, V3f(static_cast<float>(scene.patches.size()), 0, 0), material % 2 == 1);
    const Scene read = there_and_back(scene);
    EXPECT_EQ(read.materials.size(), 4u);
    for (std::size_t i = 0; i < scene.patches.size(); ++i) {
        EXPECT_EQ(material_of(read, read.patches[i]).name, material_of(scene, scene.patches[i]).name);
        expect_colour(material_of(read, read.patches[i]).reflectance, material_of(scene, scene.patches[i]).reflectance,
                      "patch " + std::to_string(i));
        EXPECT_EQ(read.patches[i].other_side, scene.patches[i].other_side);
    }
}

TEST(WriteMgf, MaterialNamesTheFormatHasNoRoomFor) {
    std::vector<Material> materials;
    for (const char* const name : {"two words", "-", "-x", "=", "==", "back\\", "#", "a\tb\n"})
        materials.push_back({.name = name, .reflectance = Rgb(.5f)});
    const Scene read = there_and_back(scene_of(materials));
    std::vector<std::string> names;
    for (const Patch& patch : read.patches) names.push_back(material_of(read, patch).name);
    EXPECT_EQ(names, (std::vector<std::string>{"two_words", "_", "_x", "_", "==", "back_", "#", "a_b_"}));
}

// ---- Objects

TEST(WriteMgf, ObjectNamesAreNested) {
    Scene scene;
    scene.materials = {{.name = "grey", .reflectance = {.5f, .5f, .5f}}};
    scene.objects = {"",
                     "room",
                     "room.desk",
                     "room.desk.leg",
                     "room.chair",
                     "roof",
                     std::string(200, 'x') + "." + std::string(200, 'y')};
    for (const std::uint32_t object : {0u, 3u, 2u, 4u, 0u, 1u, 5u, 3u, 6u}) {
        add_triangle(scene, 0, V3f(static_cast<float>(scene.patches.size()), 0, 0));
        scene.patches.back().object = object;
    }
    expect_same_scene(there_and_back(scene), scene);
    EXPECT_NE(mgf_of(scene).find("o room\no desk\no leg\n"), std::string::npos);
}

TEST(WriteMgf, ObjectNamesTheFormatHasNoRoomFor) {
    Scene scene = scene_of({{.name = "grey", .reflectance = {.5f, .5f, .5f}}});
    scene.objects.push_back(".a b..c\n.");
    scene.patches[0].object = 1;
    const Scene read = there_and_back(scene);
    EXPECT_EQ(read.objects[read.patches[0].object], "_.a_b._.c_._");
}

// ---- Files

TEST(WriteMgf, FailsWhereNothingCanBeWritten) {
    const Scene scene = make_maze({.rooms = 1});
    std::ostringstream broken;
    broken.setstate(std::ios::badbit);
    EXPECT_THROW(write_mgf(scene, broken), std::runtime_error);
    EXPECT_THROW(write_mgf(scene, "/dev/full"), std::runtime_error);
    const TemporaryFolder folder;
    EXPECT_THROW(write_mgf(scene, folder.path() / "missing" / "maze.mgf"), std::runtime_error);
    EXPECT_THROW(write_view_list(scene.views, folder.path() / "missing" / "maze.views.json"), std::runtime_error);
}

TEST(WriteMgf, ViewsComeBackToTheBit) {
    const TemporaryFolder folder;
    std::vector<View> views = make_maze({.rooms = 9}).views;
    views.push_back({"\"quoted\" \\ \n ü", {1e-20f, -3.4e14f, 0.1f}, {16777216, 1.f / 3, 0}, {0, 1, 1e-3f}, 59.9999f});
    write_view_list(views, folder.path() / "maze.views.json");
    const std::vector<View> read = read_view_list(folder.path() / "maze.views.json");
    ASSERT_EQ(read.size(), views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        EXPECT_EQ(read[i].name, views[i].name);
        EXPECT_EQ(read[i].eye, views[i].eye);
        EXPECT_EQ(read[i].look_at, views[i].look_at);
        EXPECT_EQ(read[i].up, views[i].up);
        EXPECT_EQ(read[i].fov, views[i].fov);
    }
    write_view_list({}, folder.path() / "none.views.json");
    EXPECT_TRUE(read_view_list(folder.path() / "none.views.json").empty());
}

TEST(WriteMgf, SceneWithItsViewsIsLoaded) {
    const TemporaryFolder folder;
    const Scene maze = make_maze({.rooms = 4});
    write_mgf(maze, folder.path() / "maze.mgf");
    write_view_list(maze.views, folder.path() / "maze.views.json");
    const Scene read = load_scene(folder.path() / "maze.mgf");
    expect_same_scene(read, maze);
    EXPECT_EQ(read.views.size(), maze.views.size());
}

}  // namespace
}  // namespace interflect
