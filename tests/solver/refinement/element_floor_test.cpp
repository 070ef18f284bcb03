// Smallest size of elements: the area that a pixel of the nearest view shows. For unseen elements, a length that
// depends on the surfaces of the scene, not on the size of the world. Seen to fail if the cosine is omitted or may be
// smaller, the first view replaces the nearest, the scene's origin is ignored, the length for unseen elements grows
// with the world, the pixel's area applies to unseen elements too, or a given area applies only to them.

#include "interflect/solver/state/element_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

Scene room() { return closed_box({4, 3, 2.5f}, 1, {{"wall", Rgb(0.5f), Rgb(1)}}); }

/// Returns a view with an angle of 90 degrees over 100 pixels: at distance 1, a pixel is 0.02 wide.
WeightedView from(Imath::V3d eye) {
    WeightedView view;
    view.view = {"view", eye, eye + Imath::V3d(0, 1, 0), {0, 0, 1}, 90};
    view.pixel_rows = 100;
    return view;
}

TEST(ElementFloor, IsWhatAPixelShows) {
    SolveOptions options{.method = find_method("srr")};
    options.views = {from({0, 0, 0})};
    const ElementFloor floor(room(), options);
    const V3f facing(0, -1, 0), oblique(0, -0.5f, std::sqrt(0.75f)), grazing(0, 0, 1);
    EXPECT_NEAR(floor.pixel_area({0, 1, 0}, facing), 0.0004f, 1e-9f);
    EXPECT_NEAR(floor.pixel_area({0, 2, 0}, facing), 0.0016f, 1e-9f) << "grows with the square of the distance";
    EXPECT_NEAR(floor.pixel_area({0, 2, 0}, oblique), 0.0032f, 1e-8f) << "and with the obliquity,";
    EXPECT_NEAR(floor.pixel_area({0, 2, 0}, grazing), 0.016f, 1e-8f) << "but tenfold at most";
    EXPECT_EQ(floor.min_area({0, 2, 0}, facing, true), floor.pixel_area({0, 2, 0}, facing));
    EXPECT_EQ(floor.min_area({0, 2, 0}, facing, false), floor.default_min_area());
}

TEST(ElementFloor, IsThatOfTheNearestViewInWorldCoordinates) {
    SolveOptions options{.method = find_method("srr")};
    options.views = {from({0, 0, 0}), from({0, 9, 0})};
    const V3f facing(0, -1, 0);
    EXPECT_NEAR(ElementFloor(room(), options).pixel_area({0, 8, 0}, facing), 0.0004f, 1e-9f);
    Scene moved = room();
    moved.origin = {0, 1e6, 0};
    for (WeightedView& view : options.views) view.view.eye += moved.origin;
    EXPECT_NEAR(ElementFloor(moved, options).pixel_area({0, 8, 0}, facing), 0.0004f, 1e-9f);
}

TEST(ElementFloor, WithoutAViewIsThatOfUnseenElements) {
    const ElementFloor floor(room(), {});
    EXPECT_TRUE(std::isinf(floor.pixel_area({0, 1, 0}, {0, -1, 0})));
    EXPECT_EQ(floor.min_area({0, 1, 0}, {0, -1, 0}, true), floor.default_min_area());
}

TEST(ElementFloor, GivenByTheCallerHoldsEverywhere) {
    SolveOptions options{.method = find_method("srr")};
    options.views = {from({0, 0, 0})};
    options.refinement.min_area = 0.25;
    const ElementFloor floor(room(), options);
    EXPECT_EQ(floor.default_min_area(), 0.25f);
    EXPECT_EQ(floor.min_area({0, 1, 0}, {0, -1, 0}, true), 0.25f);
}

TEST(ElementFloor, DoesNotDependOnTheSizeOfTheWorld) {
    const float expected = ElementFloor(room(), {}).default_min_area();
    EXPECT_GT(expected, 1e-6f);
    EXPECT_LE(expected, 25e-6f) << "at most 5 mm";
    Scene with_stray_face = room();
    add_rectangle(with_stray_face, {1e5f, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    EXPECT_EQ(ElementFloor(with_stray_face, {}).default_min_area(), expected);
}

}  // namespace
}  // namespace interflect
