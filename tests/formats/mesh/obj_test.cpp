// OBJ files and material libraries.
#include "interflect/formats/mesh/obj/obj.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "interflect/formats/build/texture_files.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"
#include "interflect/load.h"
#include "tests/support/parameter_names.h"
#include "tests/support/refusals.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using namespace testing_support;

const std::string obj_square = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n";

Scene parse_obj(const std::string& text, const ReadOptions& options = {}) {
    return read_obj_text(text, "room.obj", options);
}

TEST(Obj, FaceIsTwoSidedWithItsFrontCounterClockwise) {
    const Scene scene = parse_obj("# made by hand\n" + obj_square + "f 1 2 3 4  # the floor\n");
    ASSERT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(PatchGeometry(scene, scene.patches[0]).normal(), V3f(0, 0, 1));
    EXPECT_EQ(patch_area(scene, scene.patches[0]), 2);
    EXPECT_EQ(scene.materials[scene.patches[0].material].reflectance, Rgb(0.5f));
}

class ObjIndices : public testing::TestWithParam<const char*> {};
TEST_P(ObjIndices, OfAnyFormGiveTheSameFaces) {
    const Scene scene = parse_obj(obj_square + "vt 0 0\nvn 0 0 1\n" + GetParam());
    EXPECT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(patch_area(scene, scene.patches[0]), 2);
}
INSTANTIATE_TEST_SUITE_P(, ObjIndices,
                         testing::Values("f 1 2 3 4\n", "f 1/1 2/1 3/1 4/1\n", "f 1//1 2//1 3//1 4//1\n",
                                         "f 1/1/1 2/1/1 3/1/1 4/1/1\n", "f -4 -3 -2 -1\n", "f 1 2 \\\n 3 4\n",
                                         "f 1 2 3\nf 1 3 4\n", "f 1 2 3 4 4\n"),
                         printed_name);

TEST(Obj, PolygonsOfAnyShapeKeepTheirArea) {
    const Scene scene = parse_obj("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n");  // an inverted W
    double area = 0;
    for (std::size_t i = 0; i < scene.patches.size(); i += 2) area += patch_area(scene, scene.patches[i]);
    EXPECT_NEAR(area, 16 - 6, 1e-5);
}

TEST(Obj, ObjectsAndGroupsNameFaces) {
    const Scene scene = parse_obj(obj_square + "f 1 2 3\no desk\nf 1 2 3\ng leg left\nf 1 2 3\no chair\nf 1 2 3\n");
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.patches.size(); i += 2) names.push_back(scene.objects[scene.patches[i].object]);
    EXPECT_EQ(names, (std::vector<std::string>{"", "desk", "desk.leg left", "chair"}));
}

TEST(Obj, CoordinatesFarAwayKeepTheirPrecision) {
    const Scene scene = parse_obj("v 5000000.001 0 0\nv 5000000.003 0 0\nv 5000000.003 0.001 0\nf 1 2 3\n");
    EXPECT_NEAR(patch_area(scene, scene.patches[0]), 1e-6, 1e-11);
}

struct Finish {
    const char* name;
    const char* lines;
    Rgb reflectance, exitance, transmittance;
};
void PrintTo(const Finish& finish, std::ostream* out) { *out << finish.name; }
class ObjMaterial : public testing::TestWithParam<Finish> {};
TEST_P(ObjMaterial, IsMapped) {
    const TemporaryFolder folder;
    folder.write("my paints.mtl",
                 std::string("# paints\nnewmtl other\nKd 1 1 1\nnewmtl red paint\n") + GetParam().lines);
    const Scene scene =
        load_scene(folder.write("room.obj", "mtllib my paints.mtl\n" + obj_square + "usemtl red paint\nf 1 2 3 4\n"));
    const Material& found = scene.materials[scene.patches[0].material];
    EXPECT_EQ(found.name, "red paint");
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(found.reflectance[c], GetParam().reflectance[c]);
        EXPECT_FLOAT_EQ(found.exitance[c], GetParam().exitance[c]);
        EXPECT_FLOAT_EQ(found.transmittance[c], GetParam().transmittance[c]);
    }
    EXPECT_EQ(scene.materials[scene.patches[1].material].exitance, Rgb(0));  // of the back
    EXPECT_EQ(scene.files.size(), 2u);
}
const float pi_f = static_cast<float>(pi);
INSTANTIATE_TEST_SUITE_P(
    , ObjMaterial,
    testing::Values(
        Finish{"Diffuse", "Ka 1 1 1\nKd .2 .4 .6\nNs 10\nillum 2\n", Rgb(.2f, .4f, .6f), Rgb(0), Rgb(0)},
        Finish{"Grey", "Kd .3\n", Rgb(.3f), Rgb(0), Rgb(0)}, Finish{"Nothing", "", Rgb(.5f), Rgb(0), Rgb(0)},
        Finish{"Comments", "Kd .2 .4 .6 # blue\nKe 0 # off\nd .5 #half\n", Rgb(.1f, .2f, .3f), Rgb(0), Rgb(.5f)},
        Finish{"TooWhite", "Kd 1 1 1\n", Rgb(.99f), Rgb(0), Rgb(0)},
        Finish{"Emission", "Kd 0 0 0\nKe 10 20 30\n", Rgb(0), Rgb(10, 20, 30) * pi_f, Rgb(0)},
        Finish{"EmissionDissolves", "Kd 0 0 0\nKe 10 20 30\nd .25\n", Rgb(0), Rgb(2.5f, 5, 7.5f) * pi_f, Rgb(.75f)},
        Finish{"Dissolve", "Kd .4 .4 .4\nd .25\n", Rgb(.1f), Rgb(0), Rgb(.75f)},
        Finish{"Transparency", "Kd .4 .4 .4\nTr .75\n", Rgb(.1f), Rgb(0), Rgb(.75f)},
        Finish{"DissolveBeforeTransparency", "Kd .4 .4 .4\nTr 1\nd 1\n", Rgb(.4f), Rgb(0), Rgb(0)}),
    testing::PrintToStringParamName());

TEST(ObjNames, MayBeFollowedByComments) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl Material #25\nKd .25 .25 .25\nnewmtl red\nKd .75 0 0\n");
    const Scene scene =
        load_scene(folder.write("room.obj", "mtllib a.mtl  # paints\n" + obj_square +
                                                "usemtl Material #25\nf 1 2 3\nusemtl red\t# walls\nf 1 3 4\n"));
    EXPECT_EQ(scene.materials[scene.patches[0].material].name, "Material #25") << "the exact name comes first";
    EXPECT_EQ(scene.materials[scene.patches.back().material].name, "red");
    for (const Warnings::Entry& warning : scene.warnings.entries()) EXPECT_NE(warning.kind, "missing-material");
}

TEST(ObjNames, MayBeFollowedByCommentsWhereTheyAreDefined) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl Material #25\nKd .25\nnewmtl wood # oak\nKd .5\nnewmtl Material #26\nKd .75\n");
    const Scene scene = load_scene(folder.write(
        "room.obj", "mtllib a.mtl\n" + obj_square +
                        "usemtl wood\nf 1 2 3\nusemtl wood # floor\nf 1 3 4\nusemtl Material #25\nf 1 2 4\n"));
    ASSERT_EQ(scene.patches.size(), 4u) << "two triangles of one material are a square";
    EXPECT_EQ(scene.materials[scene.patches[0].material].name, "wood");
    EXPECT_EQ(scene.materials[scene.patches[2].material].name, "Material #25");
    for (const Warnings::Entry& warning : scene.warnings.entries()) EXPECT_NE(warning.kind, "missing-material");
    const Scene other =
        load_scene(folder.write("other.obj", "mtllib a.mtl\n" + obj_square + "usemtl Material\nf 1 2 3\n"));
    EXPECT_EQ(other.warnings.entries().at(0).kind, "missing-material") << "two materials have this name";
    EXPECT_NE(other.warnings.entries().at(0).message.find("several definitions"), std::string::npos);
}

/// A triangle 2 mm long and 3 um wide, six float steps at its position, beside a floor of 8 x 8 m. It is negligible,
/// not a sign of too coarse coordinates. Seen to be refused when its length counts.
TEST(Obj, SliversThatRoundingFlattensAreLeftOut) {
    const Scene scene = parse_obj(
        "v 0 0 0\nv 8 0 0\nv 8 8 0\nv 0 8 0\nv 7.1 7.3 2\nv 7.102 7.3 2\nv 7.101 7.300003 2\nf 1 2 3 4\nf 5 6 7\n");
    EXPECT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(scene.warnings.entries().at(0).kind, "degenerate-face");
}

TEST(Obj, TextureMultipliesTheReflectance) {
    const TemporaryFolder folder;
    Texture texture{"wood.png", 2, 1, {Rgb(1), Rgb(0)}};
    write_texture(folder.path() / "wood.png", texture);
    folder.write("a.mtl", "newmtl wood\nKd 1 1 .5\nmap_Kd -s 2 2 -clamp on wood.png\n");
    const Scene scene =
        load_scene(folder.write("room.obj", "mtllib a.mtl\n" + obj_square +
                                                "vt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3 4/4\n"));
    const Material& wood = scene.materials[scene.patches[0].material];
    ASSERT_NE(wood.reflectance_texture, none);
    EXPECT_FLOAT_EQ(wood.reflectance.x, 0.99f);
    EXPECT_FLOAT_EQ(wood.reflectance.z, 0.5f);
    EXPECT_EQ(scene.texture_coordinates[scene.patches[0].vertices[2]], V2f(.5f, 1));
}

const std::string textured_face = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3 4/4\n";

/// Returns a scene of one face with the material "wood", which has these lines.
Scene scene_of_wood(const TemporaryFolder& folder, const std::string& lines) {
    folder.write("a.mtl", "newmtl wood\n" + lines);
    return load_scene(folder.write("room.obj", "mtllib a.mtl\n" + obj_square + textured_face));
}

std::int64_t warning_count(const Scene& scene, const std::string& kind) {
    std::int64_t count = 0;
    for (const Warnings::Entry& warning : scene.warnings.entries())
        if (warning.kind == kind) count += warning.count;
    return count;
}

TEST(Obj, NamesOfTexturesMayBeFollowedByComments) {
    const TemporaryFolder folder;
    for (const std::string name : {"wood.png", "wood#2.png", "wood #3.png"})
        write_texture(folder.path() / name, {"", 1, 1, {Rgb(1)}});
    for (const std::string words : {"wood.png # oak", "wood.png\t#oak", "-s 2 2 wood#2.png # oak", "wood #3.png"}) {
        const Scene scene = scene_of_wood(folder, "Kd .5\nmap_Kd " + words + "\n");
        EXPECT_NE(scene.materials[scene.patches[0].material].reflectance_texture, none) << words;
        EXPECT_EQ(warning_count(scene, "missing-texture"), 0) << words;
    }
}

TEST(Obj, TexturesAboveOneLimitTheReflectanceWithAWarning) {
    const TemporaryFolder folder;
    write_texture(folder.path() / "bright.exr", {"", 1, 1, {Rgb(2)}});
    write_texture(folder.path() / "white.png", {"", 1, 1, {Rgb(1)}});
    const Scene bright = scene_of_wood(folder, "Kd .8\nmap_Kd bright.exr\n");
    EXPECT_FLOAT_EQ(bright.materials[bright.patches[0].material].reflectance.x, 0.495f);
    EXPECT_EQ(warning_count(bright, "reflectance-clamped"), 1);
    const std::string mask = "map_d white.png\n";
    EXPECT_EQ(warning_count(scene_of_wood(folder, "Kd .8\nmap_Kd bright.exr\n" + mask), "reflectance-clamped"), 1);
    EXPECT_EQ(warning_count(scene_of_wood(folder, "Kd .8\nmap_Kd white.png\n"), "reflectance-clamped"), 0);
    EXPECT_EQ(warning_count(scene_of_wood(folder, "Kd .8\nmap_Kd white.png\n" + mask), "reflectance-clamped"), 0);
}

/// Kd is 1 in most files with textures. Seen to reduce all colours by 1% when Kd alone is limited to 0.99.
TEST(Obj, TexturesHaveTheirColoursIfKdIsOne) {
    const TemporaryFolder folder;
    write_texture(folder.path() / "grey.exr", {"", 1, 1, {Rgb(0.5f)}});
    const Scene scene = scene_of_wood(folder, "Kd 1 1 1\nmap_Kd grey.exr\n");
    const Rgb factor = scene.materials[scene.patches[0].material].reflectance;
    EXPECT_NEAR(factor.x, 1, 1e-6);
    EXPECT_LT(factor.x, 1) << "as Material requires";
    EXPECT_EQ(warning_count(scene, "reflectance-clamped"), 0);
}

TEST(Obj, LightThatIsLeftOutGivesAWarning) {
    const TemporaryFolder folder;
    const auto count = [&](const std::string& lines, const std::string& kind) {
        return warning_count(scene_of_wood(folder, lines), kind);
    };
    EXPECT_EQ(count("Ke 1 1 1\nmap_Ke lamp.png\n", "emission-texture"), 1);
    EXPECT_EQ(count("Ke 1 1 1\n", "emission-texture"), 0);
    EXPECT_EQ(count("Ks .5 .5 .5\nmap_Ks gloss.png\n", "specular-reflection"), 1);
    EXPECT_EQ(count("map_Ks gloss.png\n", "specular-reflection"), 1);
    EXPECT_EQ(count("Ks 0 0 0\n", "specular-reflection"), 0);
    EXPECT_EQ(count("map_Tr holes.png\n", "transmission-texture"), 1);
    for (const std::string filter : {"Tf .9 .9 .9\n", "Tf 0 1 0\n", "Tf spectral glass.rfl\n"})
        EXPECT_EQ(count(filter, "transmission-filter"), 1) << filter;
    for (const std::string filter : {"Tf 1 1 1\n", "Tf 0 0 0\n"})
        EXPECT_EQ(count(filter, "transmission-filter"), 0) << filter;
}

/// The alpha of a mask, or its greys without alpha, as stored: not decoded from sRGB.
TEST(Obj, MasksMakeHoles) {
    const TemporaryFolder folder;
    write_texture(folder.path() / "bark.png", {"", 2, 1, {Rgb(1), Rgb(1)}});
    write_texture(folder.path() / "greys.png", {"", 2, 1, {Rgb(0), Rgb(srgb_decode(0.6f))}});
    std::ofstream(folder.path() / "alpha.png", std::ios::binary)
        << codecs::encode_png(Image(2, 1, Rgb(1)), std::vector<float>{0, 0.6f});
    for (const std::string mask : {"greys.png", "alpha.png"}) {
        folder.write("a.mtl", "newmtl leaf\nKd .5 .5 .5\nd .5\nKe 1 1 1\nmap_Kd bark.png\nmap_d " + mask + "\n");
        const Scene scene =
            load_scene(folder.write("room.obj", "mtllib a.mtl\n" + obj_square +
                                                    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl leaf\nf 1/1 "
                                                    "2/2 3/3 4/4\n"));
        const Material& leaf = scene.materials[scene.patches[0].material];
        ASSERT_NE(leaf.transmittance_texture, none) << mask;
        const auto at = [&](std::uint32_t texture, std::size_t i) { return scene.textures.at(texture).texels.at(i).x; };
        for (const auto& [i, there] : {std::pair(0u, 0.0f), {1u, 0.3f}}) {
            EXPECT_NEAR(leaf.transmittance.x * at(leaf.transmittance_texture, i), 1 - there, 1e-5f) << mask;
            EXPECT_NEAR(leaf.reflectance.x * at(leaf.reflectance_texture, i), there / 2, 1e-5f) << mask;
            EXPECT_NEAR(at(leaf.exitance_texture, i), there, 1e-5f) << mask;
        }
    }
}

TEST(Obj, WhatIsMissingIsAWarning) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl wood\nmap_Kd missing.png\nnewmtl photo\nmap_Kd photo.jpg\n");
    const Scene scene = load_scene(folder.write("room.obj", "mtllib a.mtl none.mtl\n" + obj_square +
                                                                "usemtl wood\nf 1 2 3\nusemtl photo\nf 1 3 4\n"
                                                                "usemtl paper\nf 1 2 4\nl 1 2\ncurv 0 1 1 2\n"));
    std::vector<std::string> kinds;
    for (const auto& warning : scene.warnings.entries()) kinds.push_back(warning.kind);
    EXPECT_EQ(kinds, (std::vector<std::string>{"missing-file", "missing-texture", "missing-material",
                                               "unsupported-entity", "unsupported-entity", "no-light"}));
    EXPECT_EQ(scene.patches.size(), 6u);
}

// Fails when each line reads the file again.
TEST(Obj, LibrariesAreReadOnceHoweverOftenTheyAreNamed) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl a\nKd .2 .2 .2\n");
    std::string text = obj_square;
    for (int i = 0; i < 1000; ++i) text += "mtllib a.mtl\n";
    const Scene scene =
        load_scene(folder.write("room.obj", text + "usemtl a\nf 1 2 3 4\nmtllib a.mtl\nusemtl a\nf 1 2 3\n"));
    EXPECT_EQ(scene.files.size(), 2u);
    EXPECT_EQ(scene.patches.front().material, scene.patches.back().material);
}

TEST(Obj, FilesOutsideTheFolderAreRefused) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "scene");
    folder.write("secret.mtl", "newmtl a\n");
    folder.write("scene/a.mtl", "newmtl a\nmap_Kd ..\\secret.png\n");
    const auto message = [&](const std::string& text) {
        return message_of(
            [&] { load_scene(folder.write("scene/room.obj", text + obj_square + "usemtl a\nf 1 2 3\n")); });
    };
    expect_in(message("mtllib ../secret.mtl\n"), "room.obj:1: ");
    expect_in(message("mtllib /etc/passwd\n"), "outside the folder of the scene");
    expect_in(message("mtllib a.mtl\n"), "a.mtl:2: the texture '../secret.png' lies outside the folder of the scene");
}

/// Each was refused.
TEST(Obj, OddLinesOfExportersGiveAWarning) {
    const auto kind_of = [](const std::string& text) {
        const Scene scene = parse_obj(text);
        EXPECT_EQ(scene.patches.size(), 2u) << text;
        EXPECT_EQ(patch_area(scene, scene.patches[0]), 2) << text;
        EXPECT_EQ(scene.warnings.entries().size(), 1u) << text;
        return scene.warnings.entries().empty() ? "" : scene.warnings.entries()[0].kind;
    };
    EXPECT_EQ(kind_of(obj_square + "f 1 2\nf 1\nf\nf 1 2 3 4\n"), "degenerate-face");
    EXPECT_EQ(kind_of("f 1 2 3 4\n" + obj_square), "later-vertices");
    EXPECT_EQ(kind_of(obj_square.substr(0, 16) + "f 1//1 2//1 3//1 4//1\n" + obj_square.substr(16) + "vn 0 0 1\n"),
              "later-vertices");
    EXPECT_EQ(kind_of(obj_square + "vt nan inf\nvn nan nan nan\nf 1/1/1 2/1/1 3/1/1 4/1/1\n"), "invalid-coordinates");
}

TEST(Obj, NegativeIndicesCountBackFromTheirLineAfterReadingAhead) {
    const Scene scene = parse_obj("f 5 6 7\n" + obj_square + "f -4 -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf -3 -2 -1\n");
    ASSERT_EQ(scene.patches.size(), 6u);
    std::vector<float> areas;
    for (const Patch& patch : scene.patches) areas.push_back(patch_area(scene, patch));
    std::sort(areas.begin(), areas.end());
    EXPECT_EQ(areas, (std::vector<float>{0.5f, 0.5f, 0.5f, 0.5f, 2, 2}));
}

class ObjBadText : public testing::TestWithParam<BadText> {};
TEST_P(ObjBadText, IsNamedWithItsFault) {
    const std::string error = message_of([] { parse_obj(obj_square + GetParam().text); });
    expect_in(error, "room.obj");
    expect_in(error, GetParam().expected);
}
INSTANTIATE_TEST_SUITE_P(
    , ObjBadText,
    testing::Values(BadText{"Empty", "", "the scene is empty"},
                    BadText{"BeyondTheLast", "f 1 2 5", ":5: there is no vertex 5: 4"},
                    BadText{"Giant", "f 1 2 1000000000", "there is no vertex 1000000000"},
                    BadText{"BeyondSixtyFourBits", "f 1 2 99999999999999999999", "expected the number of a vertex"},
                    BadText{"BeforeTheFirst", "f -1 -2 -5", "there is no vertex -5"},
                    BadText{"Zero", "f 0 1 2", "expected the number of a vertex, not '0'"},
                    BadText{"Word", "f a b c", "not 'a'"},
                    BadText{"BadLaterVertex", "f 5 6 7\nv 1 2", ":6: a vertex needs"},
                    BadText{"CutVertex", "v 1 2", ":5: a vertex needs three coordinates"},
                    BadText{"NaN", "v nan 0 0", "expected a finite number, not 'nan'"},
                    BadText{"Infinity", "v 1e999 0 0", "not '1e999'"}, BadText{"Junk", "v 1x 0 0", "not '1x'"},
                    BadText{"CutCoordinate", "vt", "texture coordinates need a number"},
                    BadText{"LongName", "o " + std::string(1000, 'a'), "name is too long"},
                    BadText{"FarAway", "v 1e20 0 0\nf 1 2 5", "object '', material 'default'"},
                    BadText{"Binary", std::string(1, '\x02'), "this is not a text file"}),
    testing::PrintToStringParamName());

class MtlBadText : public testing::TestWithParam<BadText> {};
TEST_P(MtlBadText, IsNamedWithItsFault) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl a\n" + GetParam().text);
    const fs::path path = folder.write("room.obj", "mtllib a.mtl\n" + obj_square + "usemtl a\nf 1 2 3\n");
    const std::string error = message_of([&] { load_scene(path); });
    expect_in(error, "a.mtl:");
    expect_in(error, GetParam().expected);
}
INSTANTIATE_TEST_SUITE_P(, MtlBadText,
                         testing::Values(BadText{"Negative", "Kd -1 0 0", ":2: Kd is negative"},
                                         BadText{"CutColour", "Kd 1 0", "one number or three"},
                                         BadText{"Spectrum", "Kd spectral a.rfl 1",
                                                 "a.mtl:2: expected a finite number, not ..."},
                                         BadText{"NoShare", "d 2", "d is 2; expected 0 to 1"},
                                         BadText{"TooBright", "Ke 1e20 0 0", "material 'a': the exitance"},
                                         BadText{"LongName", "newmtl " + std::string(1000, 'a'), "is too long"}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace interflect
