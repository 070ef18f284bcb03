#include "interflect/render/pictures/outlines.h"

#include <gtest/gtest.h>

#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::add_material;
using testing_support::add_rectangle;

const Rgb grey(0.2f, 0.2f, 0.2f), red(1, 0, 0);
constexpr int size = 32;  // [pixels]

/// From (0, -1, 0) towards +y; at the plane y = 0 the picture is 2 high.
const View view{"plane", V3f(0, -1, 0), V3f(0, 0, 0), V3f(0, 0, 1), 90};

Scene square(float half) {
    Scene scene;
    add_rectangle(scene, V3f(-half, 0, -half), V3f(2 * half, 0, 0), V3f(0, 0, 2 * half),
                  add_material(scene, grey, Rgb(0, 0, 0)));
    return scene;
}

Image outlined(const Scene& scene, const ElementForest& forest, const OutlineOptions& options = {}, int samples = 64) {
    return draw_outlines(Image(size, size, grey), scene, forest, RayCaster(scene), view, samples, 1, options);
}

TEST(Outlines, LeaveAPictureOfOneLeafAsItIs) {
    const Scene scene = square(9);
    EXPECT_EQ(outlined(scene, ElementForest(scene, 1)).pixels, Image(size, size, grey).pixels);
}

/// The square and the picture share their centre. A line two pixels wide covers the two pixels beside each leaf border.
TEST(Outlines, LieOnTheBordersOfLeavesAsWideAsAsked) {
    const Scene scene = square(9);
    ElementForest forest(scene, 5);
    forest.subdivide(ElementIndex(0));
    const Image image = outlined(scene, forest, {.width = 2, .opacity = 1, .colour = red});
    const auto on_line = [](int i) { return i == size / 2 - 1 || i == size / 2; };
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            EXPECT_EQ(image.at(x, y), on_line(x) || on_line(y) ? red : grey) << x << ", " << y;
}

TEST(Outlines, ThatAreThinnerThanAPixelCoverAShareOfIt) {
    const Scene scene = square(9);
    ElementForest forest(scene, 5);
    forest.subdivide(ElementIndex(0));
    const Image image = outlined(scene, forest, {.width = 0.5f, .opacity = 1, .colour = red});
    EXPECT_NEAR(image.at(size / 2, 3).x, 0.75f * grey.x + 0.25f * red.x, 0.02f) << "half the line, in either pixel";
    EXPECT_NEAR(image.at(size / 2 - 1, 3).x, 0.75f * grey.x + 0.25f * red.x, 0.02f);
    EXPECT_EQ(image.at(size / 2 + 1, 3), grey);
}

/// A square from -0.5 to 0.5 without a background: its borders are at pixels 8 and 24.
TEST(Outlines, FollowSilhouettes) {
    const Scene scene = square(0.5f);
    const Image image = outlined(scene, ElementForest(scene, 1), {.width = 2, .opacity = 1, .colour = red});
    EXPECT_EQ(image.at(8, 16), red);
    EXPECT_EQ(image.at(16, 23), red);
    EXPECT_EQ(image.at(16, 16), grey);
    EXPECT_EQ(image.at(2, 2), grey);
}

TEST(Outlines, OfLeavesSmallerThanAPixelLetThePictureThrough) {
    const Scene scene = square(1);
    ElementForest forest(scene, 1 << 14);
    for (ElementIndex e{0}; forest.level(e) < 6; ++e) forest.subdivide(e);
    const Rgb mixed = grey * 0.75f + red * 0.25f;
    EXPECT_EQ(outlined(scene, forest, {.width = 2, .opacity = 0.25f, .colour = red}).at(5, 5), mixed);
}

TEST(Outlines, RefuseWhatDoesNotFitTogether) {
    const Scene scene = square(1);
    const ElementForest forest(scene, 1);
    EXPECT_THROW(outlined(scene, forest, {.width = 0}), InputError);
    EXPECT_THROW(outlined(scene, forest, {.opacity = 1.5f}), InputError);
    EXPECT_THROW(outlined(scene, forest, {}, 0), InputError);
    EXPECT_THROW(outlined(scene, ElementForest(Scene{}, 0)), InputError);
}

}  // namespace
}  // namespace interflect
