#include "interflect/raycast/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "interflect/core.h"

namespace interflect {

using namespace detail;
namespace {

/// From the origin along +y with z up, so that +x is to the right; 90 degrees: the image plane at distance 1 is 2 high.
View straight_view() { return {"straight", V3f(0, 0, 0), V3f(0, 5, 0), V3f(0, 0, 1), 90}; }

const Imath::V3d world(0);  // the origin of a scene in world coordinates

void expect_direction(const Ray& ray, V3f expected) {
    expected.normalize();
    EXPECT_NEAR((ray.direction - expected).length(), 0, 1e-6) << ray.direction << " instead of " << expected;
}

TEST(Camera, LooksFromTheEyeThroughTheMiddle) {
    View view = straight_view();
    view.eye = V3f(1, 2, 3);
    const Ray ray = Camera(view, 40, 20, world).ray(20, 10);
    EXPECT_EQ(ray.origin, V3f(1, 2, 3));
    expect_direction(ray, V3f(-1, 3, -3));
}

TEST(Camera, FarFromTheWorldsOriginIsExactRelativeToTheScenes) {
    const Imath::V3d origin(1e7, -1e7, 3e6);
    View view = straight_view();
    view.eye = origin + Imath::V3d(0.1, 0.2, 0.3);
    view.look_at = origin + Imath::V3d(0.1, 0.7, 0.3);
    const Ray ray = Camera(view, 40, 20, origin).ray(20, 10);
    EXPECT_LT((ray.origin - V3f(0.1f, 0.2f, 0.3f)).length(), 1e-6f);
    expect_direction(ray, V3f(0, 1, 0));
}

TEST(Camera, RefusesViewsTooFarOut) {
    View view = straight_view();
    view.eye.x = 1e16;
    EXPECT_THROW(Camera(view, 16, 9, world), InputError);
    view = straight_view();
    view.look_at.z = -1e30;
    EXPECT_THROW(Camera(view, 16, 9, world), InputError);
}

TEST(Camera, FieldOfViewSpansTheHeightAndPixelsAreSquare) {
    const Camera camera(straight_view(), 40, 20, world);
    expect_direction(camera.ray(20, 0), V3f(0, 1, 1));    // top edge: 45 degrees up
    expect_direction(camera.ray(20, 20), V3f(0, 1, -1));  // bottom edge
    expect_direction(camera.ray(0, 0), V3f(-2, 1, 1));    // twice as wide as high
    expect_direction(camera.ray(40, 20), V3f(2, 1, -1));
    expect_direction(camera.ray(21, 9), V3f(0.1f, 1, 0.1f));  // a pixel is 2 / 20
}

TEST(Camera, UpNeedBeNeitherUnitNorPerpendicular) {
    View tilted = straight_view();
    tilted.up = V3f(0, 7, 0.5f);
    const Ray expected = Camera(straight_view(), 40, 20, world).ray(3, 4),
              found = Camera(tilted, 40, 20, world).ray(3, 4);
    expect_direction(found, expected.direction);
}

TEST(Camera, NarrowFieldOfView) {
    View view = straight_view();
    view.fov = 10;
    const Ray top = Camera(view, 10, 10, world).ray(5, 0);
    EXPECT_NEAR(std::atan2(top.direction.z, top.direction.y), 5 * std::numbers::pi / 180, 1e-6);
}

std::string refusal(const View& view, int width = 16, int height = 9) {
    try {
        Camera(view, width, height, world);
    } catch (const InputError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(Camera, RefusesViewsThatShowNothing) {
    using testing::HasSubstr;
    View view = straight_view();
    view.look_at = view.eye;
    EXPECT_THAT(refusal(view), HasSubstr("view 'straight': eye and look-at are the same point"));
    view = straight_view();
    view.up = V3f(0, -2, 0);
    EXPECT_THAT(refusal(view), HasSubstr("parallel to the direction"));
    view.up = V3f(0, 0, 0);
    EXPECT_THAT(refusal(view), HasSubstr("up (0, 0, 0) is zero"));
    view = straight_view();
    for (const float fov : {0.0f, 180.0f, -45.0f, std::numeric_limits<float>::quiet_NaN()}) {
        view.fov = fov;
        EXPECT_THAT(refusal(view), HasSubstr("field of view"));
    }
    view = straight_view();
    view.eye.x = std::numeric_limits<float>::infinity();
    EXPECT_THAT(refusal(view), HasSubstr("must be finite"));
}

// Seen to fail: such rays were quantised in steps of 6e-8, which gave blocks in the picture.
TEST(Camera, RefusesPixelsFinerThanDirections) {
    View view = straight_view();
    view.fov = 0.01f;
    EXPECT_THAT(refusal(view, 16, 9), "not refused");
    EXPECT_THAT(refusal(view, 1600, 900), testing::HasSubstr("expected a field of view of 0.0123 degrees or more"));
    view.fov = 0.0124f;
    EXPECT_THAT(refusal(view, 1600, 900), "not refused");
}

TEST(Camera, FarFromASmallSceneIsAccurateToAPixel) {
    View view = straight_view();
    view.fov = 0.0124f;
    for (const double distance : {1e3, 1e8, 1e14}) {
        view.eye = Imath::V3d(distance / 3, -distance, 0.7);
        view.look_at = Imath::V3d(0.2, 0.3, 0.1);
        const Ray ray = Camera(view, 1600, 900, world).ray(800, 450);
        const Imath::V3d to_scene = view.look_at - Imath::V3d(ray.origin), direction(ray.direction);
        const double pixel = to_scene.length() * 0.0124 * std::numbers::pi / 180 / 900;
        EXPECT_LT((to_scene - direction * to_scene.dot(direction)).length(), pixel) << distance;
    }
}

/// From the plane y = 1, 4 m high and 8 m wide in 40 x 20 pixels.
View orthographic_view() {
    View view = straight_view();
    view.eye = V3f(10, 1, 3);
    view.look_at = V3f(10, 2, 3);
    view.extent = 4;
    return view;
}

TEST(Camera, OrthographicRaysAreParallelFromThePlaneThroughTheEye) {
    const Camera camera(orthographic_view(), 40, 20, world);
    const auto expect_ray = [&](float x, float y, const V3f& origin) {
        const Ray ray = camera.ray(x, y);
        EXPECT_LT((ray.origin - origin).length(), 1e-5f) << ray.origin << " instead of " << origin;
        EXPECT_EQ(ray.direction, V3f(0, 1, 0));
    };
    expect_ray(20, 10, V3f(10, 1, 3));
    expect_ray(0, 0, V3f(6, 1, 5));
    expect_ray(40, 20, V3f(14, 1, 1));
    expect_ray(21, 9, V3f(10.2f, 1, 3.2f));
}

TEST(Camera, RefusesOrthographicViewsThatShowNothing) {
    for (const float extent : {-1.0f, std::nanf(""), std::numeric_limits<float>::infinity(), 1e-6f}) {
        View view = orthographic_view();
        view.extent = extent;
        EXPECT_THROW(Camera(view, 40, 20, world), InputError) << extent;
    }
    View near = orthographic_view();
    near.extent = 1e-3f;
    EXPECT_NO_THROW(Camera(near, 40, 20, world));
}

TEST(Camera, RefusesImpossibleSizes) {
    EXPECT_THAT(refusal(straight_view(), 0, 9), testing::HasSubstr("0 x 9 pixels"));
    EXPECT_THAT(refusal(straight_view(), 16, -1), testing::HasSubstr("16 x -1 pixels"));
    EXPECT_THAT(refusal(straight_view(), 1 << 20, 1 << 20), testing::HasSubstr("at most 268435456 pixels"));
}

}  // namespace
}  // namespace interflect
