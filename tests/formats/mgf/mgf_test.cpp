// The reader's results for each entity.
#include "interflect/formats/mgf/mgf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
using std::numbers::pi;
namespace {

/// Corners of the unit square, and of a square of half the size inside it.
const std::string vertices =
    "v a =\n p 0 0 0\nv b =\n p 1 0 0\nv d =\n p 1 1 0\nv e =\n p 0 1 0\n"
    "v ha =\n p .25 .25 0\nv hb =\n p .75 .25 0\nv hd =\n p .75 .75 0\nv he =\n p .25 .75 0\n";
const std::string one_sided = "m grey =\n rd .5\n sides 1\n";

Scene parse_mgf(const std::string& text, const ReadOptions& options = {}) {
    Scene scene = read_mgf_text(text, "test.mgf", options);
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
    return scene;
}

/// Faces between the vertices above, one-sided and grey.
Scene read_faces(const std::string& text) { return parse_mgf(vertices + one_sided + text); }

const Material& material_of(const Scene& scene, std::size_t patch) {
    return scene.materials[scene.patches[patch].material];
}
const std::string& object_of(const Scene& scene, std::size_t patch) {
    return scene.objects[scene.patches[patch].object];
}
V3f normal_of(const Scene& scene, std::size_t patch) { return PatchGeometry(scene, scene.patches[patch]).normal(); }
V3f centre_of(const Scene& scene, std::size_t patch) { return PatchGeometry(scene, scene.patches[patch]).centre(); }
double total_area(const Scene& scene) {
    double area = 0;
    for (const Patch& p : scene.patches) area += patch_area(scene, p);
    return area;
}
double power(const Scene& scene) {
    double sum = 0;
    for (const Patch& p : scene.patches) sum += patch_area(scene, p) * scene.materials[p.material].exitance.x;
    return sum;
}
std::int64_t warnings(const Scene& scene, const std::string& kind) {
    std::int64_t count = 0;
    for (const auto& entry : scene.warnings.entries())
        if (entry.kind == kind) count += entry.count;
    return count;
}

void expect_rgb(const Rgb& rgb, float r, float g, float b) {
    EXPECT_FLOAT_EQ(rgb.x, r);
    EXPECT_FLOAT_EQ(rgb.y, g);
    EXPECT_FLOAT_EQ(rgb.z, b);
}

// ---- Faces

TEST(Mgf, FaceIsTwoSidedUnlessSidesSaysOne) {
    EXPECT_EQ(parse_mgf(vertices + "f a b d e\n").patches.size(), 2u);
    EXPECT_EQ(parse_mgf(vertices + "m x =\n sides 1\nf a b d e\n").patches.size(), 1u);
    EXPECT_EQ(parse_mgf(vertices + "m x =\n sides 1\n sides 2\nf a b d e\n").patches.size(), 2u);
}

TEST(Mgf, FrontIsAsWritten) {
    const Scene scene = read_faces("f a b d e\nf e d b a\n");
    EXPECT_EQ(normal_of(scene, 0), V3f(0, 0, 1));
    EXPECT_EQ(normal_of(scene, 1), V3f(0, 0, -1));
}

TEST(Mgf, FacesShareVerticesAtOnePosition) {
    const Scene scene = read_faces("v c =\n p 2 0 -0\nv a2 = a\nf a b d\nf a2 d e\nf b c d\n");
    EXPECT_EQ(scene.vertices.size(), 5u);
}

TEST(Mgf, FaceWithHoles) {
    const Scene scene = read_faces("fh a b d e - ha hb hd he\n");
    EXPECT_NEAR(total_area(scene), 0.75, 1e-6);
    EXPECT_NEAR(total_area(read_faces("fh a b d e -\n")), 1, 1e-6) << "a last '-' without a hole is legal";
}

TEST(Mgf, HoleBehindASeam) { EXPECT_NEAR(total_area(read_faces("f a b d e he hd hb ha he e\n")), 0.75, 1e-6); }

TEST(Mgf, VertexContexts) {
    // `v a` returns to a; `v b = a` copies; without a name there is an unnamed vertex, which has no effect here.
    const Scene scene = parse_mgf("v a =\n p 1 2 3\nv b = a\nv d =\n p 0 1 0\nv\n p 9 9 9\nv a\n p 0 0 0\nf a b d\n");
    EXPECT_EQ(scene.vertices, (std::vector<V3f>{{0, 0, 0}, {1, 2, 3}, {0, 1, 0}}));
}

TEST(Mgf, VertexIsWhereItIsWhenUsed) {
    const Scene scene = read_faces("f a b d\nv a =\n p 0 0 5\nf a b d\n");
    EXPECT_EQ(scene.vertices[scene.patches[0].vertices[0]], V3f(0, 0, 0));
    EXPECT_EQ(scene.vertices[scene.patches[1].vertices[0]], V3f(0, 0, 5));
}

TEST(Mgf, VertexIsWhereTheTransformPlacesItInEachUse) {
    const Scene scene = read_faces("f a b d e\nxf -t 0 0 1\nf a b d e\nxf\nf a b d e\n");
    ASSERT_EQ(scene.patches.size(), 3u);
    EXPECT_EQ(centre_of(scene, 0), V3f(.5f, .5f, 0));
    EXPECT_EQ(centre_of(scene, 1), V3f(.5f, .5f, 1));
    EXPECT_EQ(centre_of(scene, 2), V3f(.5f, .5f, 0));
}

TEST(Mgf, CopyOfAUsedVertexMoves) {
    const Scene scene = read_faces("f a b d e\nv c = d\n p 1 .5 0\nf a b c\nf a b d\n");
    ASSERT_EQ(scene.patches.size(), 3u);
    EXPECT_NEAR(total_area(scene), 1 + .25 + .5, 1e-6);
}

TEST(Mgf, ContinuedLinesAndComments) {
    EXPECT_EQ(read_faces("# f a b d \\\n f nothing of this line is read \nf a \\\n  b \\\n  d\n").patches.size(), 1u);
}

// ---- Materials and colours

TEST(Mgf, DefaultMaterialIsBlackAndTwoSided) {
    const Scene scene = parse_mgf(vertices + "f a b d\n");
    expect_rgb(material_of(scene, 0).reflectance, 0, 0, 0);
    expect_rgb(material_of(scene, 0).exitance, 0, 0, 0);
}

TEST(Mgf, NeutralReflectanceAndExitanceAreTheSameInEachChannel) {
    const Scene scene = parse_mgf(vertices + "m x =\n rd .9\n ed 1000\nf a b d\n");
    EXPECT_EQ(material_of(scene, 0).name, "x");
    expect_rgb(material_of(scene, 0).reflectance, 0.9f, 0.9f, 0.9f);
    expect_rgb(material_of(scene, 0).exitance, 1000, 1000, 1000);
}

TEST(Mgf, FlatSpectrumIsNeutral) {
    const Scene scene = parse_mgf(vertices + "c flat =\n cspec 380 780 .9 .9 .9\nm x =\n c flat\n rd .9\nf a b d\n");
    expect_rgb(material_of(scene, 0).reflectance, 0.9f, 0.9f, 0.9f);
}

TEST(Mgf, ColourGivesTheChromaticityRdAndEdTheLuminance) {
    for (const char* colour : {"cxy .4 .45", "cct 3000", "cspec 400 700 .1 .2 .3 .4 .5"}) {
        const Scene scene = parse_mgf(vertices + "m x =\n c\n " + colour + "\n rd .3\n ed 500\nf a b d\n");
        const Material& material = material_of(scene, 0);
        EXPECT_NEAR(luminance(material.reflectance), 0.3, 1e-6) << colour;
        EXPECT_NEAR(luminance(material.exitance), 500, 1e-3) << colour;
        EXPECT_GT(material.reflectance.x, material.reflectance.z) << "all these are yellowish; " << colour;
        EXPECT_GT(material.exitance.x, material.exitance.z) << colour;
    }
}

TEST(Mgf, ColourIsTheOneInForceWhenThePropertyIsSet) {
    const Scene scene = parse_mgf(vertices + "c red =\n cxy .5 .33\nm x =\n rd .2\n c\n ed 7\n c red\nf a b d\n");
    EXPECT_GT(material_of(scene, 0).reflectance.x, 0.25f);
    expect_rgb(material_of(scene, 0).exitance, 7, 7, 7);
}

TEST(Mgf, MixedColours) {
    const Scene mixed = parse_mgf(vertices +
                                  "c y =\n cxy .4 .5\nc b =\n cxy .2 .1\n"
                                  "m x =\n c\n cmix .7 y .3 b\n rd .3\nf a b d\n");
    // X = .7 .4/.5 + .3 .2/.1 = 1.16, Y = 1, Z = .7 .1/.5 + .3 .7/.1 = 2.24: x = .263636, y = .227273.
    const Scene same = parse_mgf(vertices + "m x =\n c\n cxy .26363636 .22727273\n rd .3\nf a b d\n");
    EXPECT_LT((V3f(material_of(mixed, 0).reflectance) - V3f(material_of(same, 0).reflectance)).length(), 1e-5f);
}

TEST(Mgf, NamedAndUnnamedColourContexts) {
    const Scene scene = parse_mgf(vertices +
                                  "c red =\n cxy .5 .33\nc pale = red\nc\n cxy .3 .6\nc red\n"
                                  "m x =\n c pale\n rd .2\nf a b d\nm y =\n c red\n rd .2\nf a b d\n"
                                  "m z =\n c\n rd .2\nf a b d\n");
    EXPECT_EQ(V3f(material_of(scene, 0).reflectance), V3f(material_of(scene, 2).reflectance));
    expect_rgb(material_of(scene, 4).reflectance, 0.2f, 0.2f, 0.2f);
}

TEST(Mgf, MaterialIsAsItIsWhenUsed) {
    const Scene scene =
        read_faces("f a b d\n rd .25\nf a b d\nm grey =\nf a b d\nm\n rd .125\nf a b d\nm grey\nf a b d\n");
    const float expected[] = {0.5f, 0.25f, 0, 0, 0.125f, 0.125f, 0, 0};  // the default is two-sided
    ASSERT_EQ(scene.patches.size(), std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i)
        EXPECT_EQ(material_of(scene, i).reflectance.x, expected[i]) << i;
}

TEST(Mgf, MaterialFromATemplate) {
    const Scene scene = read_faces("m copy = grey\n ed 3\nf a b d\nm grey\nf a b d\n");
    ASSERT_EQ(scene.patches.size(), 2u) << "the copy is one-sided as well";
    EXPECT_EQ(material_of(scene, 0).name, "copy");
    EXPECT_EQ(material_of(scene, 0).reflectance.x, 0.5f);
    EXPECT_EQ(material_of(scene, 0).exitance.x, 3);
    EXPECT_EQ(material_of(scene, 1).exitance.x, 0);
}

TEST(Mgf, MaterialThatIsAPlainCopyHasItsOwnName) {
    const Scene scene = read_faces("f a b d\nm copy = grey\nf a b d\n");
    EXPECT_EQ(material_of(scene, 0).name, "grey");
    EXPECT_EQ(material_of(scene, 1).name, "copy");
}

TEST(Mgf, MaterialThatIsDefinedAgainTheSameIsOneMaterial) {
    EXPECT_EQ(read_faces("f a b d\n" + one_sided + "f a b d\n").materials.size(), 1u);
}

TEST(Mgf, ReflectanceIsClampedWithAWarning) {
    const Scene scene = parse_mgf(vertices + "m x =\n rd 1.5\nf a b d\n");
    expect_rgb(material_of(scene, 0).reflectance, 0.99f, 0.99f, 0.99f);
    EXPECT_EQ(warnings(scene, "reflectance-clamped"), 1);
    EXPECT_EQ(scene.warnings.entries()[0].where, "test.mgf:18");
}

TEST(Mgf, WhatDiffuseTransportLeavesOutIsCountedWithItsShare) {
    const Scene scene = parse_mgf(vertices +
                                  "m x =\n rd .5\n rs .2 .1\n td .05\n ts .05 0\n ir 1.5 0\nf a b d\n"
                                  "m y =\n rd .2\nf a b d\nm unused =\n rs .9 0\n");
    EXPECT_EQ(warnings(scene, "specular-reflection"), 1);
    EXPECT_EQ(warnings(scene, "diffuse-transmission"), 1);
    EXPECT_EQ(warnings(scene, "rough-transmission"), 0);
    EXPECT_NE(scene.warnings.entries()[0].message.find(" 20.0% "), std::string::npos)  // .2 of 1
        << scene.warnings.entries()[0].message;
}

TEST(Mgf, ThinGlassAndMirrorsHaveTheColourInForce) {
    const Scene scene =
        parse_mgf(vertices +
                  "m glass =\n c red = \n  cxy .64 .33\n ts .10632 0\n c\n rd .1\n rs .3 .01\nf a b d\n"
                  "m rough =\n rs .4 .1\n ts .5 .3\nf a b d\nm bright =\n rd .5\n ts .6 0\n rs .2 0\nf a b d\n");
    EXPECT_NEAR(material_of(scene, 0).transmittance.x, 0.49, 0.01);
    EXPECT_NEAR(material_of(scene, 0).transmittance.y, 0, 0.01);
    expect_rgb(material_of(scene, 0).specular_reflectance, 0.3f, 0.3f, 0.3f);
    expect_rgb(material_of(scene, 2).transmittance, 0.5f, 0.5f, 0.5f);
    expect_rgb(material_of(scene, 2).specular_reflectance, 0, 0, 0);
    EXPECT_NEAR(material_of(scene, 4).transmittance.y, 0.375, 1e-5);
    EXPECT_NEAR(material_of(scene, 4).specular_reflectance.y, 0.125, 1e-5);
    EXPECT_EQ(warnings(scene, "rough-transmission"), 1);
    EXPECT_EQ(warnings(scene, "reflectance-clamped"), 1);
    EXPECT_TRUE(scene_faults(scene).empty());
}

// ---- Objects

TEST(Mgf, ObjectsNest) {
    const Scene scene = read_faces("f a b d\no room\no desk\nf a b d\no\nf a b d\no\no room\no desk\nf a b d\no\no\n");
    EXPECT_EQ(object_of(scene, 0), "");
    EXPECT_EQ(object_of(scene, 1), "room.desk");
    EXPECT_EQ(object_of(scene, 2), "room");
    EXPECT_EQ(scene.patches[3].object, scene.patches[1].object);
}

TEST(Mgf, UnbalancedObjectsAreWarnedOf) {
    EXPECT_EQ(warnings(read_faces("o\nf a b d\n"), "unbalanced-object"), 1);
    EXPECT_EQ(warnings(read_faces("o x\no y\nf a b d\n"), "unclosed-object"), 2);
}

// ---- Transforms

TEST(Mgf, TransformsNestTheInnerFirst) {
    const Scene scene = read_faces("xf -t 10 0 0\nxf -s 2\nf a b d e\nxf\nf a b d e\nxf\nf a b d e\n");
    EXPECT_EQ(centre_of(scene, 0), V3f(11, 1, 0));
    EXPECT_EQ(centre_of(scene, 1), V3f(10.5f, 0.5f, 0));
    EXPECT_EQ(centre_of(scene, 2), V3f(0.5f, 0.5f, 0));
}

TEST(Mgf, MirrorImageKeepsTheFrontOutside) {
    // The square faces up. Mirrored in x it still does; mirrored in z it faces down; two mirrors cancel.
    const Scene scene = read_faces(
        "xf -mx\nf a b d e\nxf\nxf -mz\nf a b d e\nxf\nxf -mx\nxf -my\nf a b d e\nxf\nxf\nxf -s -1\nf a b d e\nxf\n");
    const float up[] = {1, -1, 1, -1};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(normal_of(scene, i).z, up[i]) << i;
}

TEST(Mgf, MirroredCurvesKeepTheFrontOutside) {
    const Scene scene = read_faces("v s =\n p 5 0 0\nxf -mx\nsph s 1\nprism a b d e .5\nxf\n");
    for (std::size_t i = 0; i < 128; ++i) EXPECT_GT(normal_of(scene, i).dot(centre_of(scene, i) - V3f(-5, 0, 0)), 0);
    const V3f middle(-0.5f, 0.5f, -0.25f);
    for (std::size_t i = 128; i < 134; ++i) EXPECT_GT(normal_of(scene, i).dot(centre_of(scene, i) - middle), 0);
}

TEST(Mgf, ArrayReadsItsBodyForEachCopy) {
    const Scene scene = read_faces("o row\nxf -t 0 0 1 -a 3 -t 2 0 0\no tile\nf a b d e\no\nxf\no\n");
    ASSERT_EQ(scene.patches.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(centre_of(scene, i), V3f(0.5f + 2.0f * static_cast<float>(i), 0.5f, 1));
        EXPECT_EQ(object_of(scene, i), "row.a" + std::to_string(i) + ".tile");
    }
}

TEST(Mgf, ArraysNestAndHaveManyDimensions) {
    const Scene nested = read_faces("xf -a 2 -t 10 0 0\nxf -a 3 -t 0 10 0\nf a b d e\nxf\nf a b d\nxf\n");
    EXPECT_EQ(nested.patches.size(), 2u * (3 + 1));
    const Scene grid = read_faces("xf -a 2 -t 10 0 0 -a 3 -t 0 10 0\nf a b d e\nxf\nf a b d\n");
    ASSERT_EQ(grid.patches.size(), 2u * 3 + 1);
    EXPECT_EQ(centre_of(grid, 1), V3f(0.5f, 10.5f, 0)) << "the last array runs fastest";
    EXPECT_EQ(object_of(grid, 5), "a1.2");
    EXPECT_EQ(object_of(grid, 6), "");
}

TEST(Mgf, ContextsOutliveAnArraysCopies) {
    // Each copy changes the vertex from which the next one starts.
    const Scene scene = read_faces("xf -a 2 -t 0 0 1\nf a b d\nv a\n p 0 0 .5\nxf\n");
    EXPECT_EQ(scene.vertices[scene.patches[0].vertices[0]], V3f(0, 0, 0));
    EXPECT_EQ(scene.vertices[scene.patches[1].vertices[0]], V3f(0, 0, 1.5f));
}

TEST(Mgf, UnclosedTransformIsWarnedOf) {
    const Scene scene = read_faces("xf -t 0 0 1\nf a b d e\n");
    EXPECT_EQ(centre_of(scene, 0).z, 1);
    EXPECT_EQ(warnings(scene, "unclosed-transform"), 1);
    EXPECT_EQ(scene.warnings.entries()[0].where, "test.mgf:20");
}

// ---- Curves

TEST(Mgf, CurvedEntities) {
    const std::string ends = one_sided + "v a =\n p 0 0 0\n n 0 0 2\nv b =\n p 0 0 1\n";
    EXPECT_EQ(parse_mgf(ends + "sph a 1\n").patches.size(), 128u);
    EXPECT_EQ(parse_mgf(ends + "cyl a 1 b\n").patches.size(), 16u);
    EXPECT_EQ(parse_mgf(ends + "cone a 1 b 0\n").patches.size(), 16u);
    EXPECT_EQ(parse_mgf(ends + "ring a .5 1\n").patches.size(), 16u);
    EXPECT_EQ(parse_mgf(ends + "torus a .5 1\n").patches.size(), 256u);
    EXPECT_EQ(parse_mgf(ends + "sph a 1\n", {.curve_divisions = 2}).patches.size(), 32u);
}

TEST(Mgf, CurvesAreTransformed) {
    const Scene scene = parse_mgf(one_sided + "v a =\n p 1 0 0\nxf -s 2 -t 0 0 7\nsph a -1\nxf\n");
    for (const V3f& x : scene.vertices) EXPECT_NEAR((x - V3f(2, 0, 7)).length(), 2, 1e-5);
    for (std::size_t i = 0; i < scene.patches.size(); ++i)
        EXPECT_LT(normal_of(scene, i).dot(centre_of(scene, i) - V3f(2, 0, 7)), 0) << "a negative radius looks inside";
}

TEST(Mgf, CurvedLampsHaveTheirPower) {
    const std::string lamp = "m lamp =\n ed 100\n sides 1\nv a =\n p 3 1 0\n n 0 0 2\nv b =\n p 3 1 4\n";
    const std::pair<std::string, double> lamps[] = {
        {"sph a 2", 16 * pi},         {"sph a -2", 16 * pi},         {"cyl a .5 b", 4 * pi},
        {"cyl a -.5 b", 4 * pi},      {"cone a 3 b 0", 15 * pi},     {"cone a -1 b -4", 25 * pi},
        {"ring a 0 2", 4 * pi},       {"ring a 1 2", 3 * pi},        {"torus a 1 3", 8 * pi * pi},
        {"torus a 0 2", 4 * pi * pi}, {"torus a -1 -3", 8 * pi * pi}};
    for (const auto& [entity, area] : lamps)
        for (const int divisions : {2, 3, 4, 8, 32}) {
            const ReadOptions options{.curve_divisions = divisions};
            EXPECT_NEAR(power(parse_mgf(lamp + entity + "\n", options)) / (100 * area), 1, 1e-5) << entity << divisions;
            EXPECT_NEAR(power(parse_mgf(lamp + "sides 2\n" + entity + "\n", options)) / (200 * area), 1, 1e-5)
                << entity;
            EXPECT_NEAR(power(parse_mgf(lamp + "xf -s 3 -rx 20\n" + entity + "\nxf\n", options)) / (900 * area), 1,
                        1e-5);
        }
}

TEST(Mgf, LampFlushInARoundHoleKeepsItsPower) {
    const Scene scene =
        parse_mgf(one_sided + "v a =\n n 0 0 -1\nring a 1 4\nm lamp =\n ed 100\n sides 1\nring a 0 1\n");
    const RayCaster ray_caster(scene);
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const bool is_lamp = material_of(scene, i).exitance.x > 0;
        EXPECT_EQ(ray_caster.uncovered_share(i) == 1, is_lamp) << "the lamp covers the border of the hole";
    }
}

TEST(Mgf, Prism) {
    const Scene scene = read_faces("prism a b d e .5\n");
    EXPECT_EQ(scene.patches.size(), 6u);
    EXPECT_NEAR(total_area(scene), 2 * 1 + 4 * 0.5, 1e-6);
    for (const V3f& x : scene.vertices) EXPECT_TRUE(x.z == 0 || x.z == -0.5f) << "it goes to behind its face";
}

// ---- Files

TEST(Mgf, IncludeIsRelativeToTheFileAndTransformed) {
    const testing_support::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "parts" / "deep");
    folder.write("parts/square.mgf", vertices + one_sided + "i deep/face.mgf\n");
    folder.write("parts/deep/face.mgf", "f a b d e\n");
    folder.write("above.mgf", "v top =\n p 0 0 9\n");
    const auto main = folder.write("parts/main.mgf",
                                   "i ../above.mgf\ni square.mgf -t 5 0 0\ni square.mgf -a 2 -t 0 0 3\nf a b top\n");
    const Scene scene = read_mgf(main);
    ASSERT_EQ(scene.patches.size(), 4u);
    EXPECT_EQ(centre_of(scene, 0), V3f(5.5f, 0.5f, 0));
    EXPECT_EQ(centre_of(scene, 2), V3f(0.5f, 0.5f, 3));
    EXPECT_EQ(object_of(scene, 2), "a1");
    EXPECT_EQ(scene.files.size(), 4u) << "each file once, however often it is included";
    EXPECT_EQ(scene.files[0], main.string());
    EXPECT_EQ(warnings(scene, "unclosed-transform"), 0);
}

TEST(Mgf, UnknownEntitiesAreSkippedWithAWarning) {
    const Scene scene = read_faces("/usr/rad/old.rad 1 2\nwhat is this\nf a b d\n");
    EXPECT_EQ(warnings(scene, "unsupported-entity"), 2);
    EXPECT_EQ(scene.warnings.entries()[0].where, "test.mgf:20");
}

TEST(Mgf, FaceOfFewerThanThreeVerticesIsLeftOutWithAWarning) {
    const Scene scene = read_faces("f a b b\nf a b a b\nf a b d\n");
    EXPECT_EQ(scene.patches.size(), 1u);
    ASSERT_EQ(scene.warnings.entries().size(), 1u);
    EXPECT_EQ(scene.warnings.entries()[0].message, "face with fewer than three different vertices is left out");
    EXPECT_EQ(warnings(scene, "degenerate-face"), 2);
}

TEST(Mgf, FaceThatCrossesItselfIsReportedAsSuch) {
    const Scene scene = read_faces("f a b e d\nf a b d\n");
    EXPECT_EQ(scene.patches.size(), 1u);
    EXPECT_EQ(scene.warnings.entries()[0].message.find("face whose outline crosses itself"), 0u);
}

// Seen to fail while a colour's fault made the whole file unreadable.
TEST(Mgf, FaultsThatNoFaceUsesAreIgnoredWithAWarning) {
    const Scene scene = read_faces(
        "c odd =\n cxy 1 1\n cspec 380 780 0 0\n cmix 1 nowhere 1 odd\n cct x\n cxy 1\nm unused =\n rd -1\n sides 3\n"
        "m good =\n c\n rd .5\nf a b d\n");
    EXPECT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(warnings(scene, "unused-fault"), 7);
    EXPECT_EQ(scene.warnings.entries().size(), 1u);
}

TEST(Mgf, ChromaticityWithoutLuminanceIsTakenWithAWarning) {
    const auto reflectance = [](const std::string& cxy) {
        const Scene scene = read_faces("m x =\n c\n  cxy " + cxy + "\n rd .05\nf a b d\n");
        EXPECT_EQ(warnings(scene, "no-luminance"), 1);
        EXPECT_EQ(warnings(scene, "out-of-gamut"), 1);
        return scene.materials[0].reflectance;
    };
    const Rgb purple = reflectance("0.4 0"), blue = reflectance("0 0");
    EXPECT_NEAR(luminance(purple), 0.05f, 1e-6f);
    EXPECT_NEAR(luminance(blue), 0.05f, 1e-6f);
    EXPECT_GT(blue.z, 2 * blue.x);
    EXPECT_GT(purple.x, 2 * purple.y);
    EXPECT_EQ(reflectance("0.4 1e-300"), purple);
}

TEST(Mgf, ByteOrderMarkOfAnIncludedFile) {
    const testing_support::TemporaryFolder folder;
    folder.write("part.mgf", "\xef\xbb\xbf" + vertices + one_sided + "f a b d e\n");
    const Scene scene = read_mgf(folder.write("main.mgf", "\xef\xbb\xbfi part.mgf\n"));
    EXPECT_EQ(scene.patches.size(), 1u);
    EXPECT_EQ(warnings(scene, "unsupported-entity"), 0);
}

TEST(Mgf, FaceWithoutAreaIsLeftOutWithAWarning) {
    const Scene scene = read_faces("v c =\n p 2 0 0\nf a b c\nf a b d\n");
    EXPECT_EQ(scene.patches.size(), 1u);
    EXPECT_EQ(warnings(scene, "degenerate-face"), 1);
}

}  // namespace
}  // namespace interflect
