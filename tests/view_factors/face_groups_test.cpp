// Groups of faces by object, material, pattern and side.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "interflect/view_factors.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;
using testing::ElementsAre;
using testing::HasSubstr;

/// Three unit squares: 0 and 1 are the two sides of "room.wall" (brick), 2 is "room.door" (wood), 3 has neither name.
Scene three_squares() {
    Scene scene;
    for (const char* name : {"brick", "wood", ""}) scene.materials[add_material(scene, Rgb(0), Rgb(0))].name = name;
    scene.objects = {"", "room.wall", "room.door"};
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, 1, 1, true);
    add_rectangle(scene, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1);
    add_rectangle(scene, {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 2);
    for (std::uint32_t p = 0; p < 3; ++p) scene.patches[p].object = p < 2 ? 1 : 2;
    return scene;
}

std::vector<std::string> names(const std::vector<FaceGroup>& groups) {
    std::vector<std::string> result;
    for (const FaceGroup& g : groups) result.push_back(g.name);
    return result;
}

TEST(FaceGroups, AreNamedObjectsMaterialsAndFacets) {
    const Scene scene = three_squares();
    EXPECT_THAT(names(object_groups(scene)), ElementsAre("room.wall", "room.door"));
    EXPECT_THAT(object_groups(scene)[0].patches, ElementsAre(0, 1));
    EXPECT_THAT(names(material_groups(scene)), ElementsAre("brick", "wood"));
    EXPECT_THAT(names(facet_groups(scene)), ElementsAre("room.wall:0", "room.wall:1", "room.door:2"));
}

TEST(OpaqueBacks, AreBlackAndInNoGroup) {
    const Scene scene = with_opaque_backs(three_squares());
    ASSERT_EQ(scene.patches.size(), 6u) << "one more for each one-sided face";
    EXPECT_EQ(scene.patches[4].vertices[0], scene.patches[2].vertices[0]);
    EXPECT_EQ(scene.patches[4].vertices[1], scene.patches[2].vertices[3]) << "reversed";
    EXPECT_EQ(scene.materials[scene.patches[4].material].reflectance, Rgb(0));
    EXPECT_THAT(names(facet_groups(scene)), ElementsAre("room.wall:0", "room.wall:1", "room.door:2"));
    EXPECT_TRUE(scene_faults(scene).empty());
}

TEST(FaceGroups, HaveTheChosenSideOfTwoSidedFaces) {
    const Scene scene = three_squares();
    EXPECT_THAT(object_groups(scene, FaceSides::front)[0].patches, ElementsAre(0));
    EXPECT_THAT(object_groups(scene, FaceSides::back)[0].patches, ElementsAre(1));
    EXPECT_THAT(object_groups(scene, FaceSides::back)[1].patches, ElementsAre(2)) << "one-sided faces always belong";
}

TEST(FaceGroups, TakeTheFirstPatternThatMatches) {
    const Scene scene = three_squares();
    const FacePattern patterns[] = {{"doors", "wood"}, {"all", "room"}};
    const std::vector<FaceGroup> groups = pattern_groups(scene, patterns);
    EXPECT_THAT(names(groups), ElementsAre("doors", "all"));
    EXPECT_THAT(groups[0].patches, ElementsAre(2));
    EXPECT_THAT(groups[1].patches, ElementsAre(0, 1));
}

std::string fault_of(const std::vector<FacePattern>& patterns) {
    try {
        pattern_groups(three_squares(), patterns);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no fault";
}

TEST(FaceGroups, RefuseFaultyPatterns) {
    EXPECT_THAT(fault_of({{"roof", "roof*"}}), HasSubstr("no object or material of a face matches 'roof*'"));
    EXPECT_THAT(fault_of({{"", "room"}}), HasSubstr("needs a name and a pattern"));
    EXPECT_THAT(fault_of({{"a", "room"}, {"a", "wood"}}), HasSubstr("two groups of faces are called 'a'"));
    EXPECT_THAT(fault_of({{"all", "room"}, {"doors", "wood"}}), HasSubstr("'wood'")) << "all doors are in 'all'";
}

}  // namespace
}  // namespace interflect
