#include "interflect/render/pictures/quantity_picture.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render.h"
#include "interflect/render/pictures/camera_samples.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::add_material;
using testing_support::add_rectangle;

const Rgb black(0, 0, 0);

/// From (0, -1, 0) towards +y; at the plane y = 0 the picture is 2 high.
const View plane_view{"plane", V3f(0, -1, 0), V3f(0, 0, 0), V3f(0, 0, 1), 90};

/// A square of 2 x 2 leaves that fills the left half of a picture twice as wide as high; the other half is empty.
struct HalfPicture {
    Scene scene;
    ElementForest forest;
    RayCaster ray_caster;
    HalfPicture() : scene(square()), forest(scene, 5), ray_caster(scene) { forest.subdivide(ElementIndex(0)); }

    static Scene square() {
        Scene made;
        add_rectangle(made, V3f(-2, 0, -1), V3f(2, 0, 0), V3f(0, 0, 2), add_material(made, Rgb(0.5f), black));
        return made;
    }
    QuantityPicture picture(const std::vector<float>& values, Spacing spacing = Spacing::linear,
                            CameraSampling sampling = {.width = 4, .height = 2}) const {
        return render_quantity(scene, forest, ray_caster, plane_view, {"level", "", values, spacing}, sampling);
    }
};

/// The root's value is not shown; children are lower left, lower right, upper left, upper right.
const std::vector<float> values{99, 1, 2, 3, 4};

TEST(QuantityPicture, HasTheValueOfTheLeafThatAPixelSees) {
    const QuantityPicture picture = HalfPicture().picture(values);
    EXPECT_EQ(picture.values.pixels, (std::vector{Rgb(3), Rgb(4), black, black, Rgb(1), Rgb(2), black, black}));
    EXPECT_EQ(picture.non_finite_pixels, 0);
}

TEST(QuantityPicture, ShowsItInColours) {
    const QuantityPicture picture = HalfPicture().picture(values);
    EXPECT_EQ(picture.scale.low, 0);
    EXPECT_EQ(picture.scale.high, 4) << "of what is seen: the root's 99 does not count";
    EXPECT_EQ(picture.shown.at(1, 0), false_colour(1));
    EXPECT_EQ(picture.shown.at(1, 1), false_colour(0.5f));
    EXPECT_EQ(picture.shown.at(2, 0), black);
    EXPECT_EQ(picture.shown.width, 4);
    EXPECT_EQ(picture.shown.height, 2);
}

TEST(QuantityPicture, LogarithmicScalesShowRatios) {
    const QuantityPicture picture = HalfPicture().picture({99, 1, 10, 100, 0}, Spacing::logarithmic);
    EXPECT_EQ(picture.shown.at(0, 1), false_colour(0));
    EXPECT_EQ(picture.shown.at(1, 1), false_colour(0.5f));
    EXPECT_EQ(picture.shown.at(0, 0), false_colour(1));
    EXPECT_EQ(picture.shown.at(1, 0), false_colour(0)) << "nothing looks like the least";
}

/// Each pixel is half upper leaf, half lower leaf; column edges coincide with pixel edges.
TEST(QuantityPicture, AveragesWithinAPixel) {
    const Image means = HalfPicture().picture(values, Spacing::linear, {.width = 2, .height = 1}).values;
    EXPECT_EQ(means.at(0, 0), Rgb(2.5f));
    EXPECT_EQ(means.at(1, 0), black);
}

/// Five columns over a width of five: the square covers half of the third one.
TEST(QuantityPicture, EscapedRaysDimTheColourAndNotTheValue) {
    const QuantityPicture picture =
        HalfPicture().picture({99, 2, 2, 2, 2}, Spacing::linear, {.width = 5, .height = 2, .samples = 64});
    EXPECT_EQ(picture.values.at(2, 0), Rgb(2));
    EXPECT_NEAR(picture.shown.at(2, 0).y, 0.5f * false_colour(1).y, 0.03f);
}

TEST(QuantityPicture, CountsWhatIsNotFiniteAndDoesNotHideIt) {
    const float infinite = std::numeric_limits<float>::infinity();
    const QuantityPicture picture = HalfPicture().picture({99, 1, 2, infinite, std::nanf("")});
    EXPECT_EQ(picture.non_finite_pixels, 2);
    EXPECT_EQ(picture.scale.high, 2);
    EXPECT_FALSE(is_finite(picture.shown.at(0, 0)));
    EXPECT_FALSE(is_finite(picture.shown.at(1, 0)));
}

TEST(QuantityPicture, IsNamedWithItsUnit) {
    EXPECT_EQ((Quantity{"irradiance", "lm/m^2", {}}).label(), "irradiance [lm/m^2]");
    EXPECT_EQ((Quantity{"level", "", {}}).label(), "level");
}

TEST(QuantityPicture, RefusesWhatDoesNotFitTogether) {
    const HalfPicture half;
    EXPECT_THROW(half.picture({1, 2, 3, 4}), InputError) << "five elements";
    EXPECT_THROW(half.picture(values, Spacing::linear, {.width = 0, .height = 1}), InputError);
    EXPECT_THROW(half.picture(values, Spacing::linear, {.width = 1, .height = 1, .samples = 0}), InputError);
}

TEST(QuantityPicture, HasTheQuantityOfASolution) {
    const Scene scene = HalfPicture::square();
    const RayCaster ray_caster(scene);
    const auto forest = std::make_shared<ElementForest>(scene, 5);
    forest->subdivide(ElementIndex(0));
    Solution solution;
    solution.forest = forest;
    solution.irradiance = {Rgb(99), Rgb(1), Rgb(2), Rgb(3), Rgb(4)};
    solution.rays = {0, 1, 1, 1, 2};
    PictureOptions options;
    options.width = 4;
    options.height = 2;
    options.samples = 1;
    const auto drawn = [&](ElementQuantity quantity) {
        return draw_quantity(scene, solution, ray_caster, plane_view, quantity, options).values.pixels;
    };
    EXPECT_EQ(drawn(ElementQuantity::irradiance),
              (std::vector{Rgb(3), Rgb(4), black, black, Rgb(1), Rgb(2), black, black}));
    EXPECT_EQ(drawn(ElementQuantity::level), (std::vector{Rgb(1), Rgb(1), black, black, Rgb(1), Rgb(1), black, black}));
    EXPECT_EQ(drawn(ElementQuantity::rays)[1], Rgb(2)) << "2 rays from 1 m2";
    EXPECT_THROW(drawn(ElementQuantity::importance), InputError) << "a solution without views";
}

}  // namespace
}  // namespace interflect
