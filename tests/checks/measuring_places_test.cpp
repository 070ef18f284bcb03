// Measuring points at invalid places.
#include "interflect/measure.h"

#include <gtest/gtest.h>

#include "tests/checks/rooms.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// A room with a table of one-sided faces, up to 0.8 m.
class MeasuringPlaces : public testing::Test {
  protected:
    MeasuringPlaces() : scene_(two_sided_room({4, 5, 3})) { add_box(scene_, {1, 1, 0}, {2, 2, 0.8f}, 0); }
    PointFault fault_at(Imath::V3d position, V3f normal = {0, 0, 1}) const {
        const MeasuringPoint point{position, normal};
        return point_faults(scene_, RayCaster(scene_), {&point, 1}).front();
    }
    Scene scene_;
};

TEST_F(MeasuringPlaces, InTheRoomAndOnItsSurfaces) {
    for (const Imath::V3d& position : {Imath::V3d(3, 3, 0.75), Imath::V3d(3, 3, 0), Imath::V3d(1.5, 1.5, 0.8),
                                       Imath::V3d(0.01, 0.01, 0.01), Imath::V3d(0.99, 1.5, 0.4)})
        EXPECT_EQ(fault_at(position), PointFault::sound) << position;
    EXPECT_EQ(fault_at({1, 1.5, 0.4}, {-1, 0, 0}), PointFault::sound);
}

TEST_F(MeasuringPlaces, OutsideOfTheRoom) {
    for (const Imath::V3d& position : {Imath::V3d(3, 3, 3.01), Imath::V3d(-0.01, 3, 1), Imath::V3d(9, 9, 9)})
        EXPECT_EQ(fault_at(position), PointFault::outside) << position;
    EXPECT_EQ(fault_at({3, 3, 0}, {0, 0, -1}), PointFault::outside);
}

TEST_F(MeasuringPlaces, InsideASolid) {
    for (const Imath::V3d& position : {Imath::V3d(1.5, 1.5, 0.75), Imath::V3d(1.01, 1.01, 0.79)})
        EXPECT_EQ(fault_at(position), PointFault::behind) << position;
    EXPECT_EQ(fault_at({1.5, 1.5, 0.81}), PointFault::sound);
}

TEST_F(MeasuringPlaces, OpenScenesHaveNoOutside) {
    open_ceiling(scene_, {0, 0}, {4, 5});
    EXPECT_EQ(fault_at({-1, 3, 1}), PointFault::sound);
}

/// A lit room of 4 x 5 x 3 m with a grid of 8 x 10 points at 0.4 m. Cupboards cover whole cells of 0.5 m.
class OpenPoints : public testing::Test {
  protected:
    OpenPoints() : scene_(two_sided_room({4, 5, 3})) {}
    void light(V3f position = {3, 4, 2.8f}) { add_light(scene_, downlight(), position); }
    MeasuringGrid grid() const {
        return without_enclosed_points(scene_, RayCaster(scene_),
                                       area_grid(scene_, find_floor(scene_, 0.4), {.spacing = 0.5}, 0.4));
    }
    Scene scene_;
};

TEST_F(OpenPoints, LieOutsideOfFurniture) {
    light();
    EXPECT_EQ(grid().points.size(), 80u);
    EXPECT_EQ(grid().enclosed, 0u);
    add_two_sided_box(scene_, {1, 1, 0.1f}, {2, 2, 0.8f});  // 2 x 2 cells
    add_box(scene_, {3, 1, 0}, {3.5f, 2, 2}, 0);            // 1 x 2 cells
    const MeasuringGrid open = grid();
    EXPECT_EQ(open.enclosed, 6u);
    ASSERT_EQ(open.points.size(), 74u);
    ASSERT_EQ(open.cells.size(), 74u);
    for (std::size_t i = 0; i < 74; ++i) {
        const Imath::V3d& p = open.points[i];
        EXPECT_FALSE((p.x > 1 && p.x < 2 && p.y > 1 && p.y < 2) || (p.x > 3 && p.x < 3.5 && p.y > 1 && p.y < 2)) << p;
        EXPECT_NEAR((open.corner + Imath::V3d(0.5 * (open.cells[i] % 8 + 0.5), 0.5 * (open.cells[i] / 8 + 0.5), 0) - p)
                        .length(),
                    0, 1e-5);
    }
}

/// A table without a wall towards the room, and a closed cupboard of glass.
TEST_F(OpenPoints, IncludePlacesThatLightReaches) {
    light();
    add_rectangle(scene_, {1, 1, 0.7f}, {1, 0, 0}, {0, 1, 0}, 0, 1, 1, true);
    const std::uint32_t glass = add_material(scene_, Rgb(0), Rgb(0));
    scene_.materials[glass].transmittance = Rgb(0.8f);
    add_two_sided_box(scene_, {2.5f, 2, 0.1f}, {3.5f, 3, 0.8f}, glass);
    EXPECT_EQ(grid().enclosed, 0u);
}

/// Reflectances do not matter: black faces keep shadows dark, but open.
TEST_F(OpenPoints, IncludeTheShadowInABlackRoom) {
    light();
    scene_.materials[0].reflectance = Rgb(0);
    add_rectangle(scene_, {1, 1, 0.7f}, {2, 0, 0}, {0, 2, 0}, 0, 1, 1, true);
    EXPECT_EQ(grid().enclosed, 0u);
}

/// Half of the room is sealed. It has its own lamp, a small emitting face, or no light, and then counts as furniture.
TEST_F(OpenPoints, OfASealedRoomNeedALamp) {
    light();
    add_rectangle(scene_, {0, 2, 0}, {4, 0, 0}, {0, 0, 3}, 0, 1, 1, true);
    EXPECT_EQ(grid().enclosed, 32u);
    const Scene sealed = scene_;
    light({0.1f, 0.1f, 2.9f});
    EXPECT_EQ(grid().enclosed, 0u);
    scene_ = sealed;
    add_rectangle(scene_, {0.1f, 0.1f, 2.9f}, {0, 0.01f, 0}, {0.01f, 0, 0}, add_material(scene_, Rgb(0), Rgb(1)));
    EXPECT_EQ(grid().enclosed, 0u);
}

TEST_F(OpenPoints, AreAllPointsOfADarkRoom) {
    EXPECT_EQ(grid().points.size(), 80u);
    EXPECT_EQ(grid().enclosed, 0u);
}

}  // namespace
}  // namespace interflect
