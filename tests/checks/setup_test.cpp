// Errors of placement, units and axes on both sides of their limits. Sound scenes have no findings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "interflect/generate.h"
#include "interflect/load.h"
#include "interflect/prepare.h"
#include "tests/checks/rooms.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> kinds(const Scene& scene) {
    std::vector<std::string> result;
    for (const Finding& finding : validate_setup(scene, RayCaster(scene))) result.push_back(finding.kind);
    return result;
}

const V3f room_size(4, 5, 3);

std::vector<std::string> with_light(V3f position, V3f direction = {0, 0, -1}) {
    Scene scene = two_sided_room(room_size);
    add_light(scene, downlight(), position, direction);
    return kinds(scene);
}

/// A room with a block whose corners have averaged normals, as some programs export them.
TEST(Setup, NormalsThatContradictPlaneFaces) {
    Scene scene = two_sided_room(room_size);
    add_light(scene, downlight(), {1, 1, 2.5f});
    const std::size_t first = scene.vertices.size();
    add_two_sided_box(scene, {2, 2, 0.1f}, {3, 3, 1});
    scene.normals.resize(scene.vertices.size(), V3f(0));
    EXPECT_THAT(kinds(scene), IsEmpty()) << "faces without normals";
    const V3f centre(2.5f, 2.5f, 0.55f);
    for (std::size_t v = first; v < scene.normals.size(); ++v)
        scene.normals[v] = (scene.vertices[v] - centre).normalized();
    const std::vector<Finding> findings = validate_setup(scene, RayCaster(scene));
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].kind, "contradicting-normals");
    EXPECT_EQ(findings[0].count, 6) << "sides, each counted once";
}

TEST(Setup, LuminaireInACeilingOrBelowIt) {
    for (const float z : {3.000001f, 3.0f, 2.999f, 2.9f, 1.5f, 0.021f})
        EXPECT_THAT(with_light({1, 1, z}), IsEmpty()) << z;
}

/// At 0.1 mm above the ceiling half of the light was lost, at 0.2 mm all of it.
TEST(Setup, LuminaireBehindACeiling) {
    for (const float z : {3.00001f, 3.0001f, 3.0002f, 3.009f})
        EXPECT_THAT(with_light({1, 1, z}), ElementsAre("close-luminaire")) << z;
}

TEST(Setup, LuminaireCloseToTheSurfaceThatItShinesAt) {
    EXPECT_THAT(with_light({1, 1, 2.981f}, {0, 0, 1}), ElementsAre("close-luminaire"));
    EXPECT_THAT(with_light({1, 1, 2.979f}, {0, 0, 1}), IsEmpty());
    EXPECT_THAT(with_light({3.981f, 1, 1}, {1, 0, 0}), ElementsAre("close-luminaire"));
}

TEST(Setup, LuminaireOutsideOfAClosedScene) {
    EXPECT_THAT(with_light({1, 1, 3.05f}), ElementsAre("outside-luminaire"));
    EXPECT_THAT(with_light({1, 1, -0.05f}), ElementsAre("outside-luminaire"));
    EXPECT_THAT(with_light({9, 1, 1}), ElementsAre("outside-luminaire"));
    EXPECT_THAT(with_light({3.95f, 4.95f, 2.95f}), IsEmpty());
    Scene scene = two_sided_room(room_size);
    scene.luminaires.push_back({"point", 0, PointLight{{-1, 1, 1}, Rgb(1)}});
    scene.luminaires.push_back({"spot", 0, SpotLight{{1, 1, 4}, {0, 0, -1}, Rgb(1)}});
    scene.luminaires.push_back({"inside", 0, PointLight{{1, 1, 1}, Rgb(1)}});
    const std::vector<Finding> findings = validate_setup(scene, RayCaster(scene));
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].count, 2);
    EXPECT_EQ(findings[0].places[0].material, "point");
    EXPECT_EQ(findings[0].places[0].position, Imath::V3d(-1, 1, 1));
}

TEST(Setup, LuminaireBelowASkylight) {
    Scene scene = two_sided_room(room_size);
    open_ceiling(scene, {1.4f, 1.8f}, {2.1f, 2.6f});  // 0.5 x 0.625 m about (1.75, 2.19)
    SpotLight spot{{1.75f, 2.19f, 2}, {0, 0, 1}, Rgb(1)};
    spot.outer_angle = 12;  // to 0.21 m from its axis
    scene.luminaires.push_back({"spot", 0, spot});
    EXPECT_THAT(kinds(scene), ElementsAre("outside-luminaire"));
    spot.outer_angle = 40;
    spot.inner_angle = 40;  // 0.31 m^2 of 2.2 m^2
    scene.luminaires[0].kind = spot;
    EXPECT_THAT(kinds(scene), IsEmpty());
}

/// A closed solid seen from outside, with lights around it.
TEST(Setup, LuminaireBesideASolid) {
    Scene scene = two_sided_room({1.9f, 4, 4});
    scene.luminaires.push_back({"point", 0, PointLight{{-1, 1, 1}, Rgb(1)}});
    EXPECT_THAT(kinds(scene), IsEmpty());
    scene.views.push_back({"inside", {1, 1, 1}, {1, 2, 1}});
    EXPECT_THAT(kinds(scene), ElementsAre("outside-luminaire"));
    scene = two_sided_room(room_size);
    scene.luminaires.push_back({"point", 0, PointLight{{-1, 1, 1}, Rgb(1)}});
    scene.views.push_back({"outside", {-5, 2, 2}, {2, 2, 2}});
    EXPECT_THAT(kinds(scene), IsEmpty());
}

/// A light beside an open scene may light it.
TEST(Setup, LuminaireBesideAnOpenScene) {
    Scene scene;
    scene.name = "floor";
    add_material(scene, Rgb(0.5f), Rgb(0));
    add_rectangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 0);
    scene.luminaires.push_back({"above", 0, PointLight{{5, 2, 3}, Rgb(1)}});
    EXPECT_THAT(kinds(scene), IsEmpty());
    scene.luminaires[0].kind = SpotLight{{5, 2, 3}, {1, 0, 0}, Rgb(1)};
    EXPECT_THAT(kinds(scene), ElementsAre("outside-luminaire"));
}

/// A luminaire above the middle of the room, with an opening of this length along the room's width of 4 m.
bool is_too_wide(Scene room, float length) {
    const auto web = downlight();
    web->opening.size = {length, 0.1f, 0};
    add_light(room, web, {2, 2.5f, 2.9f});
    return testing::Value(kinds(room), testing::Contains("wide-opening"));
}

/// The middle of a box of 0.2 m lies in the ceiling, its top in the ceiling, or its middle 0.1 m below a wider ceiling.
TEST(Setup, BoxPlacedInTheCeilingByItsMiddle) {
    const auto kinds_at = [](float height, float length) {
        Scene room = two_sided_room(room_size);
        const auto web = std::make_shared<PhotometricWeb>(*downlight());
        web->polar = {0, 180};  // to all sides
        web->opening.size = {length, 0.3f, 0.2f};
        add_light(room, web, {2, 2.5f, height});
        return kinds(room);
    };
    EXPECT_THAT(kinds_at(3, 0.3f), ElementsAre("sunk-luminaire"));
    EXPECT_THAT(kinds_at(2.9f, 0.3f), IsEmpty());
    EXPECT_THAT(kinds_at(3, 5.2f), testing::Contains("wide-opening"));
}

/// 23% of the longer opening are outside. It was compared with the diagonal of 7.07 m.
TEST(Setup, OpeningLargerThanTheRoom) {
    EXPECT_FALSE(is_too_wide(two_sided_room(room_size), 3.99f));
    EXPECT_TRUE(is_too_wide(two_sided_room(room_size), 5.2f));
    EXPECT_TRUE(is_too_wide(thick_walled_room(room_size, 0.1f), 5.2f));
    EXPECT_TRUE(is_too_wide(two_sided_room({4, 5, 3.1f}), 5.2f));
    EXPECT_FALSE(is_too_wide(two_sided_room({6, 5, 3}), 3.99f));
}

/// A part of the room's luminaire is behind a beam, but in the room.
TEST(Setup, OpeningAcrossABeam) {
    Scene scene = two_sided_room(room_size);
    add_two_sided_box(scene, {2.5f, 0, 2.7f}, {2.6f, 5, 3});
    EXPECT_FALSE(is_too_wide(scene, 3));
}

TEST(Setup, OpeningLargerThanAnOpenScene) {
    for (const float length : {7.0f, 7.1f}) {  // the room's diagonal is 7.07 m
        Scene scene = two_sided_room(room_size);
        open_ceiling(scene, {0, 0}, {4, 5});
        EXPECT_EQ(is_too_wide(scene, length), length > 7.05f) << length;
    }
}

/// A dark room with a cabinet of 0.9 x 0.9 x 2 m.
Scene room_with_cabinet() {
    Scene scene = two_sided_room(room_size);
    add_two_sided_box(scene, {3, 4, 0.01f}, {3.9f, 4.9f, 2});
    return scene;
}

/// 59 of 63 points in a room had 0 lx, without a warning.
TEST(EnclosedLuminaire, InACabinetOfADarkRoom) {
    Scene scene = room_with_cabinet();
    add_light(scene, downlight(), {3.5f, 4.5f, 1});
    EXPECT_THAT(kinds(scene), ElementsAre("enclosed-luminaire"));
    scene.views.push_back({"room", {1, 1, 1.5f}, {2, 2, 1}});
    EXPECT_THAT(kinds(scene), ElementsAre("enclosed-luminaire"));
    scene.views.push_back({"cabinet", {3.2f, 4.2f, 1.5f}, {3.5f, 4.5f, 1}});
    EXPECT_THAT(kinds(scene), IsEmpty());
}

/// It may be a small room of its own.
TEST(EnclosedLuminaire, InACabinetOfALitRoom) {
    Scene scene = room_with_cabinet();
    add_light(scene, downlight(), {3.5f, 4.5f, 1});
    add_light(scene, downlight(), {1, 1, 2.5f});
    EXPECT_THAT(kinds(scene), IsEmpty());
    scene.luminaires.pop_back();
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(1));
    add_rectangle(scene, {1, 1, 2.9f}, {0, 1, 0}, {1, 0, 0}, lamp);
    EXPECT_THAT(kinds(scene), IsEmpty());
}

TEST(EnclosedLuminaire, InThePlenumAboveACeiling) {
    Scene scene = two_sided_room(room_size);
    add_two_sided_box(scene, {0, 0, 3.001f}, {4, 5, 3.2f});
    add_light(scene, downlight(), {1, 1, 2.9f});
    EXPECT_THAT(kinds(scene), IsEmpty());
    add_light(scene, downlight(), {1, 1, 3.1f});
    EXPECT_THAT(kinds(scene), ElementsAre("enclosed-luminaire"));
}

TEST(EnclosedLuminaire, InALanternOfGlassOrOfMetal) {
    Scene scene = two_sided_room(room_size);
    scene.materials.push_back({"glass", Rgb(0), Rgb(0)});
    scene.materials[1].transmittance = Rgb(0.5f);
    add_two_sided_box(scene, {1.9f, 1.9f, 2}, {2.1f, 2.1f, 2.2f}, 1);
    scene.luminaires.push_back({"bulb", 0, PointLight{{2, 2, 2.1f}, Rgb(1)}});
    EXPECT_THAT(kinds(scene), IsEmpty());
    scene.materials[1].transmittance = Rgb(0);
    EXPECT_THAT(kinds(scene), ElementsAre("enclosed-luminaire"));
}

TEST(EnclosedLuminaire, RecessedInACeiling) {
    Scene scene = two_sided_room(room_size);
    open_ceiling(scene, {1.4f, 1.8f}, {2.1f, 2.6f});  // one patch from (1.5, 1.875) of 0.5 x 0.625 m
    const V3f x(0.5f, 0, 0), y(0, 0.625f, 0), z(0, 0, 0.2f), o(1.5f, 1.875f, 3);
    for (const auto& [corner, u, v] : {std::array{o, y, z}, std::array{o + x, z, y}, std::array{o, z, x},
                                       std::array{o + y, x, z}, std::array{o + z, y, x}})
        add_rectangle(scene, corner, u, v, 0, 1, 1, true);
    add_light(scene, downlight(), {1.75f, 2.19f, 3.15f});
    EXPECT_THAT(kinds(scene), IsEmpty());
}

/// Nine closed rooms; `lamps` of them have a luminaire.
Scene nine_rooms(int lamps) {
    Scene scene;
    scene.name = "rooms";
    scene.objects.push_back("");
    add_material(scene, Rgb(0.5f), Rgb(0));
    for (int i = 0; i < 9; ++i) {
        const V3f low(3.1f * static_cast<float>(i % 3), 3.1f * static_cast<float>(i / 3), 0);
        add_two_sided_box(scene, low, low + V3f(3));
        if (i < lamps) add_light(scene, downlight(), low + V3f(1.5f, 1.5f, 2.5f));
    }
    return scene;
}

TEST(EnclosedLuminaire, InOneOfManyClosedRooms) {
    EXPECT_THAT(kinds(nine_rooms(9)), IsEmpty());
    EXPECT_THAT(kinds(nine_rooms(3)), IsEmpty());
    EXPECT_THAT(kinds(nine_rooms(1)), ElementsAre("enclosed-luminaire"));
    Scene scene = nine_rooms(1);
    scene.views.push_back({"lit", {1, 1, 1.5f}, {2, 2, 1}});
    scene.views.push_back({"dark", {4, 1, 1.5f}, {5, 2, 1}});
    EXPECT_THAT(kinds(scene), IsEmpty());
    scene.views.erase(scene.views.begin());
    EXPECT_THAT(kinds(scene), ElementsAre("enclosed-luminaire"));
}

TEST(Setup, LuminairesOfTwoFormatsWhosePlanesDiffer) {
    for (const float c90 : {100.0f, 85.0f}) {
        Scene scene = two_sided_room(room_size);
        for (const char* name : {"one.ies", "two.ldt"}) {
            const auto web = downlight();
            web->name = name;
            web->azimuth = {0, 90, 180, 270, 360};
            web->intensities = {100, 100, 100, c90, 100, 100, 100, c90, 100, 100};
            add_light(scene, web, {2, 2, 2});
            const bool differ = c90 < 100 && scene.luminaires.size() == 2;
            EXPECT_EQ(testing::Value(kinds(scene), ElementsAre("mixed-photometry")), differ) << name << c90;
        }
    }
}

class ShutOutSky : public testing::Test {
  protected:
    ShutOutSky() : scene(two_sided_room(room_size)) { scene.luminaires.push_back({"sky", 0, UniformSky{Rgb(1)}}); }
    Scene scene;
};

TEST_F(ShutOutSky, OfAClosedRoom) { EXPECT_THAT(kinds(scene), ElementsAre("shut-out-sky")); }

TEST_F(ShutOutSky, IsAlsoTheSun) {
    scene.luminaires[0].kind = DirectionalLight{{0, 0, -1}, Rgb(1)};
    EXPECT_THAT(kinds(scene), ElementsAre("shut-out-sky"));
}

TEST_F(ShutOutSky, EntersBySkylight) {
    open_ceiling(scene, {1.4f, 1.8f}, {2.1f, 2.6f});  // one patch of 0.5 x 0.625 m
    EXPECT_THAT(kinds(scene), IsEmpty());
}

TEST_F(ShutOutSky, EntersThroughGlass) {
    scene.materials.push_back({"glass", Rgb(0), Rgb(0)});
    scene.materials[1].transmittance = Rgb(0.8f);
    scene.patches[20].material = scene.patches[21].material = 1;
    EXPECT_THAT(kinds(scene), IsEmpty());
    scene.materials[1].transmittance = Rgb(0);
    EXPECT_THAT(kinds(scene), ElementsAre("shut-out-sky"));
}

TEST_F(ShutOutSky, IsMeantWhereTheSceneIsSeenFromOutside) {
    scene.views.push_back({"outside", {-5, 2, 2}, {2, 2, 2}});
    EXPECT_THAT(kinds(scene), IsEmpty());
    scene.views.push_back({"inside", {1, 1, 1}, {2, 2, 2}});
    EXPECT_THAT(kinds(scene), ElementsAre("shut-out-sky"));
}

TEST_F(ShutOutSky, IsMeantWhereTheSceneIsLowerThanARoom) {
    scene = two_sided_room({4, 5, 1.9f});
    scene.luminaires.push_back({"sky", 0, UniformSky{Rgb(1)}});
    EXPECT_THAT(kinds(scene), IsEmpty());
}

/// Walls of 5 cm and more were not seen as closed.
TEST_F(ShutOutSky, OfARoomWithThickWallsOfOneSidedFaces) {
    for (const float thickness : {0.02f, 0.05f, 0.1f, 0.2f, 0.3f}) {
        scene = thick_walled_room(room_size, thickness);
        scene.luminaires.push_back({"sky", 0, UniformSky{Rgb(1)}});
        EXPECT_THAT(kinds(scene), ElementsAre("shut-out-sky")) << thickness;
    }
}

TEST_F(ShutOutSky, IsMeantForSolidsOfOneSidedFaces) {
    scene.vertices.clear();
    scene.patches.clear();
    add_box(scene, {0, 0, 0}, room_size, 0);
    add_box(scene, {6, 0, 0}, {9, 4, 8}, 0);
    EXPECT_THAT(kinds(scene), IsEmpty());
    add_rectangle(scene, {-5, -5, 0}, {20, 0, 0}, {0, 20, 0}, 0);  // the ground
    EXPECT_THAT(kinds(scene), IsEmpty());
}

/// Above the roof, 37% of the light left the scene and none entered the room.
TEST(Setup, LuminaireOutsideOfARoomWithThickWalls) {
    for (const float z : {2.5f, 3.5f, 4.0f}) {
        Scene scene = thick_walled_room(room_size, 0.2f);
        add_light(scene, downlight(), {2, 2, z});
        EXPECT_EQ(testing::Value(kinds(scene), ElementsAre("outside-luminaire")), z > 3) << z;
    }
}

TEST(Setup, RoomInCentimetresReadAsMetres) {
    Scene known = two_sided_room({4000, 5000, 3000});
    EXPECT_THAT(kinds(known), ElementsAre("probable-unit"));
    known.warnings.add("implausible-size", "of the reader");
    EXPECT_THAT(kinds(known), IsEmpty());
    EXPECT_THAT(kinds(two_sided_room({400, 500, 300})), ElementsAre("probable-unit"));
    EXPECT_THAT(kinds(two_sided_room({300, 100, 40})), IsEmpty());  // a hangar
}

TEST(Setup, MeshInMillimetresReadAsMetres) {
    const auto with = [](const char* name, float size, float step) {
        Scene scene;
        scene.name = name;
        add_material(scene, Rgb(0.5f), Rgb(0));
        add_rectangle(scene, {step, 0, 0}, {size, 0, 0}, {0, size, 0}, 0, 4, 4);
        return kinds(scene);
    };
    EXPECT_THAT(with("part.stl", 160, 1), ElementsAre("probable-unit"));
    EXPECT_THAT(with("part.mgf", 160, 1), IsEmpty());
    EXPECT_THAT(with("part.stl", 160, 0.5f), IsEmpty());
    EXPECT_THAT(with("part.stl", 140, 1), IsEmpty());  // 198 m across
}

/// A floor with tables, all made of one-sided boxes; y is up if `turned`.
Scene furnished_floor(const char* name, bool turned, bool has_objects = true) {
    Scene scene;
    scene.name = name;
    add_material(scene, Rgb(0.5f), Rgb(0));
    const auto add = [&](V3f low, V3f high) {
        scene.objects.push_back("object");
        const std::size_t first = scene.patches.size();
        if (turned) low = {low.x, low.z, low.y}, high = {high.x, high.z, high.y};
        add_box(scene, low, high, 0);
        for (std::size_t i = first; i < scene.patches.size() && has_objects; ++i)
            scene.patches[i].object = static_cast<std::uint32_t>(scene.objects.size() - 1);
    };
    scene.objects.push_back("");
    add({0, 0, -0.1f}, {8, 6, 0});
    for (int i = 0; i < 6; ++i) {
        const auto x = static_cast<float>(i);
        add({1 + x, 1 + 0.6f * x, 0}, {1.5f + x, 1.7f + 0.6f * x, 0.7f + 0.1f * x});
    }
    return scene;
}

TEST(Setup, MeshWithYUp) {
    EXPECT_THAT(kinds(furnished_floor("room.obj", true)), ElementsAre("probable-up-axis"));
    EXPECT_THAT(kinds(furnished_floor("room.obj", false)), IsEmpty());
    EXPECT_THAT(kinds(furnished_floor("room.mgf", true)), IsEmpty());
    EXPECT_THAT(kinds(furnished_floor("room.obj", true, false)), ElementsAre("probable-up-axis"));
    EXPECT_THAT(kinds(furnished_floor("room.obj", false, false)), IsEmpty());
    Scene seen = furnished_floor("room.obj", true);
    seen.views.push_back({"as it is", {-5, 2, 2}, {2, 2, 2}});
    EXPECT_THAT(kinds(seen), IsEmpty());
}

/// A corridor that is narrower than high, with things on a wall; they and the narrow side suggested that y is up.
TEST(Setup, CorridorWithPicturesOrLampsOnAWall) {
    for (const V3f& size : {V3f(1, 0.04f, 0.8f), V3f(0.2f, 0.2f, 0.2f)}) {
        Scene scene = closed_box({30, 2.2f, 3}, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
        scene.name = "corridor.obj";
        scene.objects = {""};
        for (int i = 0; i < 9; ++i) {
            const std::size_t first = scene.patches.size();
            const V3f corner(1 + 3 * static_cast<float>(i), 0.001f, 1.2f);
            add_box(scene, corner, corner + size, 0);
            scene.objects.push_back("thing");
            for (std::size_t k = first; k < scene.patches.size(); ++k)
                scene.patches[k].object = static_cast<std::uint32_t>(i + 1);
        }
        EXPECT_THAT(kinds(scene), IsEmpty()) << size;
    }
}

std::int64_t inverted_faces(const Scene& scene) {
    for (const Finding& finding : validate(scene, RayCaster(scene)))
        if (finding.kind == "inverted-face") return finding.count;
    return 0;
}

/// The bottom of a solid and the outer side of a wall see nothing and have the scene behind them, as they should.
TEST(InvertedFace, IsNotABottomOrAnOuterSide) {
    Scene scene = closed_box(room_size, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
    add_box(scene, {3, 4, 0}, {3.9f, 4.9f, 2}, 0);
    EXPECT_EQ(inverted_faces(scene), 0);
    EXPECT_EQ(inverted_faces(thick_walled_room(room_size, 0.02f)), 0);
    EXPECT_EQ(inverted_faces(make_two_rooms({})), 0);
}

TEST(InvertedFace, IsAWallThatFacesOutwards) {
    for (std::size_t wall = 0; wall < 6; ++wall) {
        Scene scene = closed_box(room_size, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
        add_box(scene, {1, 1, 0}, {1.9f, 1.9f, 2}, 0);
        std::swap(scene.patches[wall].vertices[1], scene.patches[wall].vertices[3]);
        EXPECT_EQ(inverted_faces(scene), 1) << wall;
    }
}

TEST(Setup, IsSoundInMadeScenes) {
    EXPECT_THAT(kinds(make_maze({.rooms = 9, .furniture = true})), IsEmpty());
    EXPECT_THAT(kinds(make_office({})), IsEmpty());
    EXPECT_THAT(kinds(make_boxes({})), IsEmpty());
    EXPECT_THAT(kinds(make_two_rooms({})), IsEmpty());
}

TEST(Setup, IsSoundInTheScenesOfTheRepository) {
    const std::filesystem::path scenes = repository() / "scenes";
    const PlacedLuminaire pendant{.file = scenes / "pendant.ies", .position = {2.5, 2, 2.2}};
    EXPECT_THAT(kinds(load_scene(scenes / "office.mgf", {}, {&pendant, 1})), IsEmpty());
#ifdef INTERFLECT_HAS_REAL_SCENES
    for (const char* name : {"corridor.mgf", "cube.mgf", "floor_gloss.mgf"})
        EXPECT_THAT(kinds(load_scene(real_scenes() / name, {.outside_files = true})), IsEmpty()) << name;
    // Square table legs with averaged normals; single strips of a reflector, which end at other objects.
    for (const char* name : {"office2.mgf", "examp1.mgf"})
        EXPECT_THAT(kinds(load_scene(real_scenes() / name, {.outside_files = true})),
                    ElementsAre("contradicting-normals"))
            << name;
#endif
}

/// A square section of 2 m through a box, in a picture of 4 m: one quarter of the picture.
TEST(ViewCoverage, SeparatesRaysThroughBacksFromRaysBesideTheScene) {
    const Scene scene = closed_box({2, 2, 2}, 1, {Material{"", Rgb(0.5f)}});
    const RayCaster ray_caster(scene);
    const View outside{.name = "", .eye = {1, -3, 1}, .look_at = {1, 0, 1}, .extent = 4};
    const ViewCoverage from_outside = view_coverage(scene, ray_caster, outside, 1);
    EXPECT_DOUBLE_EQ(from_outside.nothing, 0.75);
    EXPECT_DOUBLE_EQ(from_outside.backs, 0.25);
    View away = outside;
    away.look_at = {1, -4, 1};
    EXPECT_DOUBLE_EQ(view_coverage(scene, ray_caster, away, 1).nothing, 1);
    const ViewCoverage from_inside =
        view_coverage(scene, ray_caster, View{"", {1, 0.5, 1}, {1, 2, 1}, {0, 0, 1}, 80}, 2);
    EXPECT_EQ(from_inside.nothing, 0);
    EXPECT_EQ(from_inside.backs, 0);
}

}  // namespace
}  // namespace interflect
