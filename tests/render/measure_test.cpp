// Illuminance at points against closed forms, and against the solution used for gathering.

#include "interflect/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "interflect/core.h"
#include "interflect/render.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

using std::numbers::pi;

Scene black_room(const Luminaire& light) {
    Scene scene = closed_box({6, 6, 3}, 1, {Material{"", Rgb(0), Rgb(0)}});
    scene.luminaires.push_back(light);
    return scene;
}
const Luminaire lamp{"lamp", 0, PointLight{{3, 3, 2.9f}, Rgb(1000)}};

MeasuredIrradiance measured(const Scene& scene, const MeasuringPoint& point, int samples = 4096) {
    const RayCaster ray_caster(scene);
    return measure_irradiance(scene, nullptr, ray_caster, std::vector{point},
                              {.shading = Shading::path, .samples = samples})
        .front();
}

/// Light from one direction: I/d^2 on the facing plane; on cylinders this times sin(epsilon)/pi, on semicylinders times
/// sin(epsilon) (1 + cos alpha)/pi (EN 12464-1, CIE 136). epsilon is the angle from the axis, alpha the angle from the
/// facing direction of the semicylinder.
TEST(MeasureIrradiance, OfEveryReceiverIsThatOfOneLight) {
    const Scene scene = black_room(lamp);
    const Imath::V3d p{1.5, 2.2, 1.2};
    const V3f to_lamp = V3f(3, 3, 2.9f) - V3f(p);
    const double facing = 1000 / static_cast<double>(to_lamp.length2()),
                 sine = std::hypot(to_lamp.x, to_lamp.y) / static_cast<double>(to_lamp.length()),
                 cosine = static_cast<double>(to_lamp.z / to_lamp.length());
    EXPECT_NEAR(measured(scene, {p}).direct.x, facing * cosine, 1e-4 * facing);
    EXPECT_NEAR(measured(scene, {p, to_lamp}).direct.x, facing, 1e-4 * facing);
    EXPECT_NEAR(measured(scene, {p, -to_lamp}).direct.x, 0, 1e-6);

    const MeasuredIrradiance all_around = measured(scene, {p, {}, Receiver::cylindrical});
    EXPECT_NEAR(all_around.direct.x, facing * sine / pi, 0.01 * facing);
    EXPECT_NEAR(all_around.direct.x, facing * sine / pi, 6 * static_cast<double>(all_around.standard_error.x));
    for (const float degrees : {0.0f, 50.0f, 110.0f, 180.0f}) {
        const float turn = degrees * static_cast<float>(pi) / 180;
        const V3f towards{to_lamp.x * std::cos(turn) - to_lamp.y * std::sin(turn),
                          to_lamp.x * std::sin(turn) + to_lamp.y * std::cos(turn), 0.7f};  // its z has no effect
        const MeasuredIrradiance half = measured(scene, {p, towards, Receiver::semicylindrical});
        const double expected = facing * sine * (1 + std::cos(static_cast<double>(turn))) / pi;
        EXPECT_NEAR(half.direct.x, expected, 0.01 * facing) << degrees;
        EXPECT_NEAR(half.direct.x, expected, 6 * static_cast<double>(half.standard_error.x) + 1e-4 * facing);
    }
}

/// A closed box with uniform emission and reflection has H = M / (1 - rho), on every receiver inside and on it. The
/// emitted part arrives directly; the rest is reflected.
TEST(MeasureIrradiance, OfAFurnaceIsTheSameEverywhere) {
    const float rho = 0.6f, exitance = 100;
    Scene scene = closed_box({2, 3, 2.5f}, 1, {Material{"", Rgb(rho), Rgb(exitance)}});
    scene.origin = {1000, -500, 20};
    const RayCaster ray_caster(scene);
    const Imath::V3d middle = scene.origin + Imath::V3d(1, 1.5, 1.2), on_floor = scene.origin + Imath::V3d(0.3, 2, 0);
    const std::vector<MeasuringPoint> points{{middle},
                                             {on_floor},
                                             {middle, {1, 2, 3}},
                                             {middle, {1, 0, 0}, Receiver::semicylindrical},
                                             {middle, {}, Receiver::cylindrical, {1, 1, 0}}};
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 200'000}});
    for (const Solution* known : {static_cast<const Solution*>(nullptr), &solution}) {
        const auto found = measure_irradiance(scene, known, ray_caster, points,
                                              {.shading = known ? Shading::gather : Shading::path, .samples = 8192});
        ASSERT_EQ(found.size(), points.size());
        const double of_solution = known ? 0.01 * static_cast<double>(exitance) : 0;
        for (const MeasuredIrradiance& e : found) {
            const double error = 5 * static_cast<double>(e.standard_error.x) + of_solution + 1e-3;
            EXPECT_LT(error, 0.04 * static_cast<double>(exitance / (1 - rho)));
            EXPECT_NEAR(e.sum().x, exitance / (1 - rho), error);
            EXPECT_NEAR(e.direct.x, exitance, error);
        }
    }
}

/// A picture of irradiance shows the value of a measuring point at each surface, including black walls, and no lamps.
TEST(PathTracer, DrawsIrradianceOfWhatIsSeen) {
    const Scene scene = black_room(lamp);
    const RayCaster ray_caster(scene);
    const View down{"down", {2, 3, 2.5}, {2, 3, 0}, {0, 1, 0}, 1};
    const Rendering traced = render(
        scene, ray_caster, down,
        {.width = 3, .height = 3, .shading = Shading::path, .samples = 64, .quantity = PictureQuantity::irradiance});
    const double expected = measured(scene, {{2, 3, 0}}).sum().x;
    EXPECT_NEAR(expected, 1000 * 2.9 / std::pow(2.9 * 2.9 + 1, 1.5), 0.05);
    EXPECT_NEAR(traced.image.at(1, 1).x, expected, 0.001 * expected);

    const Scene furnace = closed_box({6, 6, 3}, 1, {Material{"", Rgb(0.5f), Rgb(10)}});
    const RayCaster of_furnace(furnace);
    const Rendering even = render(
        furnace, of_furnace, down,
        {.width = 2, .height = 2, .shading = Shading::path, .samples = 1024, .quantity = PictureQuantity::irradiance});
    EXPECT_NEAR(even.image.at(0, 0).x, 20, 6 * static_cast<double>(even.standard_error.at(0, 0).x));
    EXPECT_EQ(even.layers.emitted.at(0, 0), Rgb(0));
}

TEST(MeasureIrradiance, RefusesWhatHasNoDirection) {
    const Scene scene = black_room(lamp);
    const RayCaster ray_caster(scene);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto measure = [&](const MeasuringPoint& point) {
        return measure_irradiance(scene, nullptr, ray_caster, std::vector{point}, {.shading = Shading::path});
    };
    EXPECT_THROW(measure({{1, 1, 1}, {0, 0, 0}}), InputError);
    EXPECT_THROW(measure({{1, 1, 1}, {nan, 0, 1}}), InputError);
    EXPECT_THROW(measure({{1, std::numeric_limits<double>::infinity(), 1}}), InputError);
    EXPECT_THROW(measure({{1, 1, 1}, {0, 0, 2}, Receiver::semicylindrical}), InputError);
    EXPECT_THROW(measure({{1, 1, 1}, {1, 0, 0}, Receiver::cylindrical, {0, 0, 0}}), InputError);
    EXPECT_TRUE(measure_irradiance(scene, nullptr, ray_caster, {}, {.shading = Shading::path}).empty());
}

}  // namespace
}  // namespace interflect
