// The region with most of a scene. tests/solver/importance/position_test.cpp shows its effect; this file tests the
// rules.

#include "interflect/scene/core/core.h"

#include <gtest/gtest.h>

#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using Imath::V3d;

TEST(Core, IsTheWeightedMedian) {
    const std::vector<FaceExtent> faces = {{{1, 0, 0}, 1}, {{2, 5, 0}, 4}, {{3, 6, 0}, 1}, {{1e9, -1e9, 0}, 3}};
    EXPECT_EQ(core_of(faces).middle, V3d(2, 0, 0) + V3d(0, 5, 0));
    EXPECT_NEAR(core_of(faces).reach, 2.5, 0.5);
    EXPECT_EQ(core_of({}).reach, 0);
}

TEST(Core, KeepsTheOriginNearIt) {
    EXPECT_EQ(origin_for({{8, -8, 8}, 1}), V3d(0));
    EXPECT_EQ(origin_for({{9.2, 0.4, 0}, 1}), V3d(9, 0, 0));
    EXPECT_EQ(origin_for({{1000.3, 0, -77.6}, 3}), V3d(1000, 0, -76));  // multiples of 4
    EXPECT_EQ(origin_for({}), V3d(0));
}

TEST(Core, SampleIsBoundedAndSpreadOverAllFaces) {
    FaceSample sample;
    for (int i = 0; i < 1'000'000; ++i)
        if (sample.wants_next()) sample.add({V3d(i, 0, 0), 1});
    EXPECT_LE(sample.faces().size(), FaceSample::capacity);
    EXPECT_GT(sample.faces().size(), FaceSample::capacity / 4);
    EXPECT_NEAR(core_of(sample.faces()).middle.x, 500'000, 10'000);
}

TEST(Core, BoundsLeaveOutStrayFacesAndUnusedVertices) {
    Scene scene = closed_box({1, 2, 3}, 2, {{"wall", Rgb(0.5f), Rgb(0)}});
    scene.vertices.emplace_back(-1e6f, 0.0f, 0.0f);
    add_rectangle(scene, {1e5f, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    EXPECT_EQ(core_bounds(scene), Imath::Box3f(V3f(0), V3f(1, 2, 3)));
}

}  // namespace
}  // namespace interflect
