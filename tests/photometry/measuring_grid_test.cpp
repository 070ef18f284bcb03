// Positions of measuring points: spacing and number by EN 12464-1, within the faces of an area and off its border.

#include "interflect/measure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "interflect/core.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;
using testing::HasSubstr;

/// A point of the table in EN 12464-1 (4.4): the length of an area, and the rounding of p there [m].
struct TableRow {
    double length, spacing, rounding;
};
void PrintTo(const TableRow& row, std::ostream* out) { *out << row.length; }
class GridSpacing : public testing::TestWithParam<TableRow> {};
TEST_P(GridSpacing, IsThatOfTheStandard) {
    const auto [length, spacing, rounding] = GetParam();
    EXPECT_NEAR(grid_spacing(length, length), spacing, rounding);
    EXPECT_EQ(grid_spacing(length, 0.6 * length), grid_spacing(length, length));
    EXPECT_EQ(grid_spacing(0.6 * length, length), grid_spacing(length, length));
}
// The two shortest lengths are rounded up further than the others: to three points.
INSTANTIATE_TEST_SUITE_P(Table, GridSpacing,
                         testing::Values(TableRow{0.4, 0.15, 0.05}, TableRow{0.6, 0.2, 0.061}, TableRow{1, 0.2, 1e-9},
                                         TableRow{2, 0.3, 0.026}, TableRow{5, 0.6, 0.02}, TableRow{10, 1, 1e-9},
                                         TableRow{25, 2, 0.11}, TableRow{50, 3, 0.09}, TableRow{100, 5, 1e-9}),
                         printed_name);

TEST(GridSpacing, OfALongAreaIsThatOfItsShorterSide) {
    EXPECT_DOUBLE_EQ(grid_spacing(20, 10), 1);
    EXPECT_DOUBLE_EQ(grid_spacing(10, 100), 1);
    EXPECT_GT(grid_spacing(19.9, 10), 1.5);
    EXPECT_EQ(grid_spacing(1e4, 1e4), 10);
}

/// A desk of 2 x 1 m on a floor of 6 x 5 m, both of two-sided faces, and walls that face inwards.
Scene furnished(int divisions = 1) {
    Scene scene = closed_box({6, 5, 3}, 1, {Material{"", Rgb(0.5f), Rgb(0)}});
    scene.objects = {"", "room.floor", "room.desk.top", "room.walls"};
    for (std::uint32_t wall = 0; wall < 4; ++wall) scene.patches[wall].object = 3;
    scene.patches[4].object = 1;
    const PatchIndex top = add_rectangle(scene, {1, 2, 0.75f}, {2, 0, 0}, {0, 1, 0}, 0, divisions, divisions, true);
    for (std::uint32_t i = top; i < scene.patches.size(); ++i) scene.patches[i].object = 2;
    return scene;
}

TEST(MeasuringGrid, LiesInTheMiddlesOfCells) {
    const Scene scene = furnished();
    const MeasuringGrid grid = area_grid(scene, find_top(scene, "room.desk"));  // p(1 m) = 0.2 m
    EXPECT_EQ(grid.columns, 10);
    EXPECT_EQ(grid.rows, 5);
    ASSERT_EQ(grid.points.size(), 50u);
    EXPECT_NEAR(grid.column_spacing, 0.2, 1e-6);
    EXPECT_NEAR((grid.points.front() - Imath::V3d(1.1, 2.1, 0.75)).length(), 0, 1e-6);
    EXPECT_NEAR((grid.points.back() - Imath::V3d(2.9, 2.9, 0.75)).length(), 0, 1e-6);
    EXPECT_NEAR((grid.points[1] - grid.points[0] - Imath::V3d(0.2, 0, 0)).length(), 0, 1e-6);
    EXPECT_EQ(grid.normal, V3f(0, 0, 1));
}

/// Spacing is at most p: 6 x 5 m give p = 0.6867 m and hence 9 x 8 points.
TEST(MeasuringGrid, HasNoLargerSpacingThanAllowed) {
    const Scene scene = furnished();
    const MeasuringGrid by_standard = area_grid(scene, find_top(scene, "room.floor"));
    EXPECT_EQ(by_standard.columns, 9);
    EXPECT_EQ(by_standard.rows, 8);
    const MeasuringGrid given = area_grid(scene, find_top(scene, "room.floor"), {.spacing = 0.99});
    EXPECT_EQ(given.columns, 7);
    EXPECT_EQ(given.rows, 6);
    EXPECT_EQ(area_grid(scene, find_top(scene, "room.floor"), {.spacing = 1}).points.size(), 30u);
}

TEST(MeasuringGrid, LeavesOutTheBoundaryStrip) {
    const Scene scene = furnished();
    const MeasuringGrid grid = area_grid(scene, find_top(scene, "room.floor"), {.spacing = 1, .boundary = 0.5});
    EXPECT_EQ(grid.columns, 5);
    EXPECT_EQ(grid.rows, 4);
    EXPECT_NEAR((grid.points.front() - Imath::V3d(1, 1, 0)).length(), 0, 1e-6);
    EXPECT_THROW(area_grid(scene, find_top(scene, "room.floor"), {.boundary = 2.5}), InputError);
}

/// An L of three squares of 2 m, one of them cut into triangles. Points in the notch are omitted. A boundary strip also
/// excludes points near the notch's two sides, which a bounding rectangle would miss. The cuts are not part of the
/// border.
TEST(MeasuringGrid, KeepsToTheFacesAndTheirBorder) {
    Scene scene;
    scene.materials = {Material{}};
    scene.objects = {"", "L"};
    scene.origin = {1000, -2000, 50};
    add_rectangle(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 0, 2, 2);
    add_rectangle(scene, {2, 0, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const V3f& v : {V3f(0, 2, 0), V3f(2, 2, 0), V3f(2, 4, 0), V3f(0, 4, 0)}) scene.vertices.push_back(v);
    scene.patches.push_back({.vertices = {first, first + 1, first + 2, none}});
    scene.patches.push_back({.vertices = {first, first + 2, first + 3, none}});
    for (Patch& patch : scene.patches) patch.object = 1;
    const PlanarArea area = find_surface(scene, "L");
    EXPECT_NEAR(area.area, 12, 1e-5);
    const MeasuringGrid whole = area_grid(scene, area, {.spacing = 0.5});
    EXPECT_EQ(whole.columns, 8);
    EXPECT_EQ(whole.points.size(), 48u);
    for (const Imath::V3d& p : whole.points) EXPECT_FALSE(p.x > 1002 && p.y > -1998);
    // Cells of 0.5 m from 0.5 m on: middles at 0.75, 1.25, ... 3.25 in both directions, except in (1.5, 4)^2.
    const MeasuringGrid inner = area_grid(scene, area, {.spacing = 0.5, .boundary = 0.5});
    EXPECT_EQ(inner.columns, 6);
    EXPECT_EQ(inner.points.size(), 20u);
    for (const Imath::V3d& p : inner.points) EXPECT_FALSE(p.x > 1001.5 && p.y > -1998.5);
}

/// The same, divided like the solver's mesh: the border is still that of the whole.
TEST(MeasuringGrid, DoesNotDependOnHowFacesAreDivided) {
    for (const int divisions : {1, 3}) {
        const Scene scene = furnished(divisions);
        const MeasuringGrid grid =
            area_grid(scene, find_top(scene, "room.desk.top"), {.spacing = 0.1, .boundary = 0.25});
        EXPECT_EQ(grid.columns, 15);
        EXPECT_EQ(grid.points.size(), 75u) << divisions;
    }
}

/// Undersides of table legs lie in the plane of the floor and face up if they are two-sided. They are part of the
/// floor, also at its edges, so a strip is left out only along the walls.
TEST(MeasuringGrid, FacesOnTheFloorHaveNoBorderOfTheirOwn) {
    const auto grid_of = [](const Scene& scene) {
        return area_grid(scene, find_floor(scene, 0.75), {.spacing = 0.5, .boundary = 0.5}, 0.75);
    };
    Scene scene = furnished();
    const MeasuringGrid empty = grid_of(scene);
    EXPECT_EQ(empty.points.size(), 80u);
    for (const V3f& leg : {V3f(1, 2, 0), V3f(2.7f, 2.4f, 0), V3f(4, 4.9f, 0)})
        add_rectangle(scene, leg, {0.3f, 0, 0}, {0, 0.1f, 0}, 0, 1, 1, true);
    const MeasuringGrid with_legs = grid_of(scene);
    EXPECT_EQ(with_legs.points, empty.points);
}

/// The underside of a cupboard is no room of its own. A doorstep beside the floor is, although it is smaller.
TEST(MeasuringGrid, FurnitureOnTheFloorIsNoRoom) {
    Scene scene = furnished();
    scene.objects.insert(scene.objects.end(), {"cupboard", "doorstep"});
    add_rectangle(scene, {1, 2, 0}, {2, 0, 0}, {0, 1, 0}, 0, 1, 1, true);
    for (std::uint32_t i = 0; i < 2; ++i) scene.patches[scene.patches.size() - 1 - i].object = 4;
    add_rectangle(scene, {6, 2, 0}, {0.2f, 0, 0}, {0, 1, 0}, 0);
    scene.patches.back().object = 5;
    const std::vector<PlanarArea> rooms = divide_by_object(scene, find_floor(scene, 0.7));
    ASSERT_EQ(rooms.size(), 2u);
    EXPECT_EQ(rooms[0].name, "room.floor");
    EXPECT_EQ(rooms[1].name, "doorstep");
}

/// Faces that are cut where others touch them leave strips of a few tolerances of the outline. The test fails if
/// opposite edges do not cover each other.
TEST(MeasuringGrid, NarrowStripsHaveNoBorder) {
    Scene scene;
    scene.materials = {Material{}};
    scene.objects = {"", "floor"};
    for (const auto& [from, to] : {std::pair(0.0f, 3.0f), std::pair(3.0f, 3.00023f), std::pair(3.00023f, 6.0f)})
        add_rectangle(scene, {from, 0, 0}, {to - from, 0, 0}, {0, 5, 0}, 0);
    const MeasuringGrid grid = area_grid(scene, find_floor(scene, 0), {.spacing = 0.5, .boundary = 0.5});
    EXPECT_EQ(grid.points.size(), 80u);
}

TEST(MeasuringGrid, TurnsWithTheArea) {
    Scene scene;
    scene.materials = {Material{}};
    scene.objects = {"", "table"};
    const float c = std::cos(0.5f), s = std::sin(0.5f);
    add_rectangle(scene, {1, 1, 0.7f}, V3f(c, s, 0) * 2, V3f(-s, c, 0), 0);
    scene.patches[0].object = 1;
    const MeasuringGrid grid = area_grid(scene, find_top(scene, "table"));
    EXPECT_EQ(grid.points.size(), 50u);
    EXPECT_NEAR(grid.along_row.dot(Imath::V3d(V3f(c, s, 0))), 1, 1e-5);
}

TEST(MeasuringGrid, AtAHeightLiesOverTheFloor) {
    Scene scene = furnished();
    const PlanarArea floor = find_floor(scene, 0.7);
    EXPECT_EQ(floor.patches, std::vector{PatchIndex(4)});
    const MeasuringGrid grid = area_grid(scene, floor, {.spacing = 1}, 0.7);
    EXPECT_EQ(grid.points.size(), 30u);
    EXPECT_NEAR((grid.points.front() - Imath::V3d(0.5, 0.5, 0.7)).length(), 0, 1e-6);
    EXPECT_EQ(find_floor(scene, 2).patches, floor.patches);  // not the desk, which is smaller
    EXPECT_EQ(find_floor(scene, 0).patches, floor.patches);
    scene.origin.z = 20.3;
    EXPECT_EQ(find_floor(scene, 20.3).patches, floor.patches);
    EXPECT_THROW(find_floor(scene, 20.2), InputError);
}

/// The orientation distinguishes walls of equal size and the sides of a two-sided face.
TEST(MeasuringGrid, OfASurfaceFacesAsItDoes) {
    const Scene scene = furnished();
    try {
        find_surface(scene, "room.walls");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("0,1,0; 0,-1,0"));
    }
    EXPECT_EQ(find_surface(scene, "room.walls", V3f(0, -2, 0)).patches, std::vector{PatchIndex(3)});
    EXPECT_THROW(find_surface(scene, "room.walls", V3f(0, 0, 1)), InputError);
    EXPECT_EQ(find_surface(scene, "room.desk").normal, V3f(0, 0, 1));
    EXPECT_EQ(find_surface(scene, "room.desk", V3f(0, 0, -1)).normal, V3f(0, 0, -1));
    const MeasuringGrid wall = area_grid(scene, find_surface(scene, "room.walls", V3f(1, 0, 0)), {.spacing = 1});
    EXPECT_EQ(wall.columns, 5);
    EXPECT_EQ(wall.rows, 3);
    EXPECT_NEAR(wall.points.front().z, 0.5, 1e-6);
    EXPECT_EQ(wall.normal, V3f(1, 0, 0));
}

TEST(MeasuringGrid, NamesTheNearestObjects) {
    const Scene scene = furnished();
    for (const auto& [wrong, nearest] : {std::pair{"room.flor", "expected one of 'room.floor'"},
                                         std::pair{"desk.top", "expected one of 'room.desk.top'"}})
        try {
            find_top(scene, wrong);
            FAIL();
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr(nearest));
        }
    EXPECT_THROW(find_top(scene, "room.walls"), InputError);
    EXPECT_THROW(find_top(scene, ""), InputError);
}

TEST(MeasuringGrid, RefusesWhatCannotBe) {
    const Scene scene = furnished();
    const PlanarArea floor = find_top(scene, "room.floor");
    EXPECT_THROW(area_grid(scene, floor, {.spacing = 0}), InputError);
    EXPECT_THROW(area_grid(scene, floor, {.spacing = 1e-4}), InputError);
    EXPECT_THROW(area_grid(scene, floor, {.boundary = -1}), InputError);
    EXPECT_THROW(line_grid({0, 0, 0}, {0, 0, 0}, 3), InputError);
    EXPECT_THROW(line_grid({0, 0, 0}, {1, 0, 0}, 1), InputError);
}

TEST(MeasuringGrid, OfALineHasItsEnds) {
    const MeasuringGrid line = line_grid({0, 1, 2}, {4, 1, 2}, 5);
    ASSERT_EQ(line.points.size(), 5u);
    EXPECT_EQ(line.points.front(), Imath::V3d(0, 1, 2));
    EXPECT_EQ(line.points[1], Imath::V3d(1, 1, 2));
    EXPECT_EQ(line.points.back(), Imath::V3d(4, 1, 2));
}

TEST(PlanarArea, IsDividedByObjects) {
    Scene scene;
    scene.materials = {Material{}};
    scene.objects = {"", "small.a", "large.a0.1", "large.a12"};
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    add_rectangle(scene, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    add_rectangle(scene, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    for (std::uint32_t i = 0; i < 3; ++i) scene.patches[i].object = i + 1;
    const std::vector<PlanarArea> rooms = divide_by_object(scene, find_floor(scene, 1));
    ASSERT_EQ(rooms.size(), 2u);
    EXPECT_EQ(rooms[0].name, "large");
    EXPECT_NEAR(rooms[0].area, 2, 1e-6);
    EXPECT_EQ(rooms[1].name, "small.a");
    EXPECT_EQ(rooms[1].patches, std::vector{PatchIndex(0)});
}

}  // namespace
}  // namespace interflect
