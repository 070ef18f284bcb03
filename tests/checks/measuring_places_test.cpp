// Measuring points at invalid places.
#include "interflect/checks/measuring_places.h"

#include <gtest/gtest.h>

#include "tests/checks/rooms.h"
#include "tests/support/scenes.h"

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
        EXPECT_EQ(fault_at(position), PointFault::none) << position;
    EXPECT_EQ(fault_at({1, 1.5, 0.4}, {-1, 0, 0}), PointFault::none);
}

TEST_F(MeasuringPlaces, OutsideOfTheRoom) {
    for (const Imath::V3d& position : {Imath::V3d(3, 3, 3.01), Imath::V3d(-0.01, 3, 1), Imath::V3d(9, 9, 9)})
        EXPECT_EQ(fault_at(position), PointFault::outside) << position;
    EXPECT_EQ(fault_at({3, 3, 0}, {0, 0, -1}), PointFault::outside);
}

TEST_F(MeasuringPlaces, InsideASolid) {
    for (const Imath::V3d& position : {Imath::V3d(1.5, 1.5, 0.75), Imath::V3d(1.01, 1.01, 0.79)})
        EXPECT_EQ(fault_at(position), PointFault::behind) << position;
    EXPECT_EQ(fault_at({1.5, 1.5, 0.81}), PointFault::none);
}

TEST_F(MeasuringPlaces, OpenScenesHaveNoOutside) {
    open_ceiling(scene_, {0, 0}, {4, 5});
    EXPECT_EQ(fault_at({-1, 3, 1}), PointFault::none);
}

}  // namespace
}  // namespace interflect
