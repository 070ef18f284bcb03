// Lamps with open backs, on both sides of the limits.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "interflect/generate.h"
#include "interflect/prepare.h"
#include "tests/checks/rooms.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr float height = 3;  // of the room [m]

std::int64_t open_backs(const Scene& scene) {
    for (const Finding& finding : validate(scene, RayCaster(scene)))
        if (finding.kind == "open-lamp-back") return finding.count;
    return 0;
}

Scene room() { return two_sided_room({4, 5, height}); }

std::uint32_t add_lamp_material(Scene& scene) { return add_material(scene, Rgb(0.2f), Rgb(1000)); }

/// Adds a square panel that shines down.
void add_panel(Scene& scene, float side, float z, int divisions = 1, bool two_sided = false) {
    add_rectangle(scene, {1, 1, z}, {0, side, 0}, {side, 0, 0}, add_lamp_material(scene), divisions, divisions,
                  two_sided);
}

Scene room_with_panel(float side, float gap, int divisions = 1, bool two_sided = false) {
    Scene scene = room();
    add_panel(scene, side, height - gap, divisions, two_sided);
    return scene;
}

TEST(LampBacks, CloseBelowACeiling) {
    for (const float gap : {0.003f, 0.01f, 0.05f, 0.1f, 0.2f})
        EXPECT_EQ(open_backs(room_with_panel(0.3f, gap)), 1) << gap;
    EXPECT_EQ(open_backs(room_with_panel(1, 0.3f)), 1);
}

TEST(LampBacks, FlushWithACeilingOrFarBelow) {
    for (const float gap : {0.0f, 0.001f, 0.6f, 1.5f}) EXPECT_EQ(open_backs(room_with_panel(0.3f, gap)), 0) << gap;
    EXPECT_EQ(open_backs(room_with_panel(1, 0.001f)), 0);
}

/// Pieces are found as the whole; most of the inner ones, too.
TEST(LampBacks, DividedLamp) {
    EXPECT_GT(open_backs(room_with_panel(0.3f, 0.05f, 4)), 8);
    EXPECT_EQ(open_backs(room_with_panel(0.3f, 0.001f, 4)), 0);
}

TEST(LampBacks, SmallLamp) {
    EXPECT_EQ(open_backs(room_with_panel(0.13f, 0.05f)), 0);
    EXPECT_EQ(open_backs(room_with_panel(0.15f, 0.05f)), 1);
}

TEST(LampBacks, TwoSidedLamp) { EXPECT_EQ(open_backs(room_with_panel(0.3f, 0.05f, 1, true)), 0); }

TEST(LampBacks, AtAWallOrAboveACornice) {
    Scene scene = room();
    const std::uint32_t lamp = add_lamp_material(scene);
    add_rectangle(scene, {0.05f, 2, 1}, {0, 0.4f, 0}, {0, 0, 0.4f}, lamp);
    EXPECT_EQ(open_backs(scene), 1);
    add_two_sided_box(scene, {3.8f, 0, 2.4f}, {4, 5, 2.5f});
    add_rectangle(scene, {3.85f, 1, 2.52f}, {0.1f, 0, 0}, {0, 2, 0}, lamp);
    EXPECT_EQ(open_backs(scene), 2);
}

TEST(LampBacks, ClosedSolid) {
    Scene scene = room();
    add_box(scene, {1, 1, 2.85f}, {1.3f, 1.3f, 2.95f}, add_lamp_material(scene));
    EXPECT_EQ(open_backs(scene), 0);
}

/// The bottom of a box of one-sided faces emits. Without the box's lid its back is open.
TEST(LampBacks, Housing) {
    for (const bool has_lid : {true, false}) {
        Scene scene = room();
        const std::size_t first = scene.patches.size();
        add_box(scene, {1, 1, 2.94f}, {1.3f, 1.3f, 2.96f}, 0);
        const std::uint32_t lamp = add_lamp_material(scene);
        PerPatch<Patch> kept(scene.patches.begin(), scene.patches.begin() + static_cast<std::ptrdiff_t>(first));
        for (std::size_t i = first; i < scene.patches.size(); ++i) {
            Patch patch = scene.patches[i];
            const auto is_at = [&](float z) {
                for (const std::uint32_t v : patch.vertices)
                    if (scene.vertices[v].z != z) return false;
                return true;
            };
            if (is_at(2.94f)) patch.material = lamp;
            if (has_lid || !is_at(2.96f)) kept.push_back(patch);
        }
        scene.patches = kept;
        EXPECT_EQ(open_backs(scene), has_lid ? 0 : 1);
    }
}

/// Its back looks into a dark plenum.
TEST(LampBacks, InAFalseCeiling) {
    Scene scene = room();
    const V3f y(0, 5, 0);
    constexpr float low = 2.7f;
    add_rectangle(scene, {0, 0, low}, V3f(1, 0, 0), y, 0, 1, 1, true);
    add_rectangle(scene, {1.6f, 0, low}, V3f(2.4f, 0, 0), y, 0, 1, 1, true);
    add_rectangle(scene, {1, 0, low}, V3f(0.6f, 0, 0), V3f(0, 1, 0), 0, 1, 1, true);
    add_rectangle(scene, {1, 1.6f, low}, V3f(0.6f, 0, 0), V3f(0, 3.4f, 0), 0, 1, 1, true);
    add_panel(scene, 0.6f, low);
    EXPECT_EQ(open_backs(scene), 0);
}

TEST(LampBacks, GeneratedScenes) {
    MazeOptions maze;
    maze.rooms = 4;
    maze.furniture = true;
    EXPECT_EQ(open_backs(make_maze(maze)), 0);
    EXPECT_EQ(open_backs(make_office({})), 0);
    EXPECT_EQ(open_backs(make_boxes({})), 0);
    EXPECT_EQ(open_backs(make_two_rooms({})), 1);  // it hangs 0.2 m below the ceiling
}

}  // namespace
}  // namespace interflect
