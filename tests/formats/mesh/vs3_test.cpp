// View3D's scenes: both formats, kinds of surfaces, and faults with their lines.

#include "interflect/formats/mesh/vs3.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "tests/support/refusals.h"

namespace interflect::detail {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string vs3_square =
    "T A square\nC encl=0 list=3\nF 3\n! a comment\n"
    "V 1 0. 0. 0.\nV 2 1. 0. 0.\nV 3 1. 1. 0.\nV 4 0. 1. 0.\n";

Scene parse_vs3(const std::string& text) { return read_vs3_bytes(text, "scene.vs3", {}); }

std::string fault(const std::string& text) {
    try {
        parse_vs3(text);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no fault";
}

/// Objects of the patches that belong to one.
std::vector<std::string> named_patches(const Scene& scene) {
    std::vector<std::string> names;
    for (const Patch& p : scene.patches)
        if (p.object != 0) names.push_back(scene.objects[p.object]);
    return names;
}

TEST(Vs3, ReadsAOneSidedSurface) {
    const Scene scene = parse_vs3(vs3_square + "S 1 1 2 3 4 0 0 0.25 floor ! its name\nEnd of data\nno entry\n");
    ASSERT_EQ(scene.patches.size(), 1u);
    EXPECT_EQ(scene.objects[scene.patches[0].object], "floor");
    EXPECT_FLOAT_EQ(scene.materials[scene.patches[0].material].reflectance.x, 0.75f);
    EXPECT_EQ(PatchGeometry(scene, scene.patches[0]).normal(), V3f(0, 0, 1)) << "counter-clockwise is the front";
    EXPECT_EQ(scene.patches[0].other_side, none);
}

TEST(Vs3, ReadsTrianglesCommasAndLowerCase) {
    const Scene scene = parse_vs3("f 3\nv,1,0,0,0\nv\t2 1 0 0\nv 3 0 1 0\ns 1 1,2,3,0 0 0 1 half\n");
    ASSERT_EQ(scene.patches.size(), 1u);
    EXPECT_TRUE(scene.patches[0].is_triangle());
}

TEST(Vs3, CombinesSurfacesAndSeparatesEqualNames) {
    const Scene scene = parse_vs3(vs3_square +
                                  "V 5 2 0 0\nV 6 2 1 0\n"
                                  "S 1 1 2 3 4 0 0 1 wall\nS 2 2 5 6 3 0 1 1 other\nS 3 4 3 2 1 0 0 1 wall\n");
    EXPECT_THAT(named_patches(scene), ElementsAre("wall", "wall", "wall#3"));
}

TEST(Vs3, GivesObstructionsAndNullSurfacesNoObject) {
    const Scene scene = parse_vs3(vs3_square + "S 1 1 2 3 4 0 0 1 floor\nN 2 4 3 2 1 1 0 1 hole\nO 3 1 2 3 4\n");
    EXPECT_THAT(named_patches(scene), ElementsAre("floor"));
    ASSERT_EQ(scene.patches.size(), 3u);
    EXPECT_EQ(PatchGeometry(scene, scene.patches[1]).normal(), V3f(0, 0, 1)) << "covers the floor";
}

TEST(Vs3, PlacesMasksBeforeTheirBase) {
    const Scene scene = parse_vs3(vs3_square + "S 1 1 2 3 4 0 0 1 floor\nM 2 4 3 2 1 1 0 1 mask\n");
    EXPECT_THAT(named_patches(scene), ElementsAre("floor", "mask"));
    const PatchGeometry mask(scene, scene.patches[1]);
    EXPECT_EQ(mask.normal(), V3f(0, 0, -1));
    EXPECT_FLOAT_EQ(mask.centre().z, 0x1p-15f);
}

TEST(Vs3, ReadsShapesOfFormat3a) {
    // The example of View3D's manual: a rectangle 3 wide and 2 high whose lower left corner, seen from its front, is
    // (3, 0, 0); azimuth 0: it faces y.
    const Scene scene = parse_vs3("F 3a\nS 1 R 0 0 0.90 srf-1\n  3. 0. 0.  0 90\n 3. 2.\n");
    const PatchGeometry wall(scene, scene.patches[0]);
    EXPECT_NEAR((wall.normal() - V3f(0, 1, 0)).length(), 0, 1e-6);
    EXPECT_NEAR((wall.centre() - V3f(1.5f, 0, 1)).length(), 0, 1e-6);
    // A horizontal triangle that faces up, with its y axis to the north for azimuth 180.
    const Scene floor = parse_vs3("F 3a\nS 1 T 0 0 0.9 srf\n 0 0 0 180 0\n 0 0  1 0  0 2\n");
    EXPECT_NEAR((PatchGeometry(floor, floor.patches[0]).normal() - V3f(0, 0, 1)).length(), 0, 1e-6);
    EXPECT_NEAR((PatchGeometry(floor, floor.patches[0]).centre() - V3f(1 / 3.0f, 2 / 3.0f, 0)).length(), 0, 1e-6);
}

TEST(Vs3, WarnsOfFactorsWithReflection) {
    const Scene scene = parse_vs3("C encl=1 emit=1\n" + vs3_square + "S 1 1 2 3 4 0 0 1 floor\n");
    ASSERT_EQ(scene.warnings.entries().size(), 1u);
    EXPECT_EQ(scene.warnings.entries()[0].where, "scene.vs3:1");
}

TEST(Vs3, RefusesFaultsWithTheirLine) {
    EXPECT_THAT(fault(vs3_square), HasSubstr("the file has no surface"));
    EXPECT_THAT(fault("F 2\n"), HasSubstr("scene.vs3:1: the geometry is of format '2'; expected 3 or 3a"));
    EXPECT_THAT(fault(vs3_square + "V 6 0 0 0\n"), HasSubstr("scene.vs3:9: vertex 6 is out of sequence; expected 5"));
    EXPECT_THAT(fault(vs3_square + "V 5 0 nan 0\n"), HasSubstr("scene.vs3:9: expected a finite number, not 'nan'"));
    EXPECT_THAT(fault(vs3_square + "S 1 1 2 3\n"), HasSubstr("scene.vs3:9: expected an integer, not ''"));
    EXPECT_THAT(fault(vs3_square + "S 1 1 2 5 0 0 0 1\n"), HasSubstr("vertex 5 does not exist; expected 1 to 4"));
    EXPECT_THAT(fault(vs3_square + "S 1 1 2 3 4 0 1 1 a\n"), HasSubstr("surface 1 cannot be combined with 1"));
    EXPECT_THAT(fault(vs3_square + "S 1 1 2 3 4 0 0 1.5 a\n"), HasSubstr("the emittance of surface 1 is 1.5"));
    EXPECT_THAT(fault(vs3_square + "M 1 1 2 3 4 0 0 1 a\n"), HasSubstr("needs an earlier surface as its base, not 0"));
    EXPECT_THAT(fault("F 3a\nS 1 X 0 0 1 a\n"), HasSubstr("scene.vs3:2: the shape is not R"));
    EXPECT_THAT(fault("F 3a\nS 1 R 0 0 1 a\n0 0 0 0 90 1\n"), HasSubstr("expected a finite number, not ''"));
    EXPECT_THAT(fault(vs3_square + "Q 1\n"), HasSubstr("scene.vs3:9: 'Q' is no entry of a View3D file"));
}

TEST(Vs3, RefusesMorePatchesThanAllowed) {
    ReadOptions options;
    options.max_patches = 3;
    EXPECT_EQ(testing_support::refused_setting([&] {
                  read_vs3_bytes(vs3_square + "S 1 1 2 3 4 0 0 1 a\nS 2 4 3 2 1 0 0 1 b\n", "scene.vs3", options);
              }),
              "max_patches");
}

}  // namespace
}  // namespace interflect::detail
