#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/export.h"
#include "interflect/geometry/polygons/polygon.h"

namespace interflect {

using namespace detail;

namespace {

constexpr float reflectance = 0.5f;

/// Squares of the given areas, lit by the given irradiances.
float exposure_of(const std::vector<float>& areas, std::vector<Rgb> irradiance) {
    Scene scene;
    scene.objects = {""};
    scene.materials = {{.name = "grey", .reflectance = Rgb(reflectance)}};
    for (const float area : areas) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        const float side = std::sqrt(area), height = static_cast<float>(first);
        for (const V3f& corner :
             {V3f(0, 0, height), V3f(side, 0, height), V3f(side, side, height), V3f(0, side, height)})
            scene.vertices.push_back(corner);
        const std::vector<std::uint32_t> corners{first, first + 1, first + 2, first + 3};
        add_polygon(scene, {&corners, 1}, 0, 0, false);
    }
    Solution solution;
    solution.forest = std::make_shared<ElementForest>(scene, scene.patches.size());
    solution.irradiance = std::move(irradiance);
    return export_exposure(scene, solution);
}

/// Logarithmic mean of the displayed values, whose target is 0.2.
float displayed(float irradiance, float exposure) {
    return irradiance * reflectance * std::numbers::inv_pi_v<float> * std::exp2(exposure);
}

TEST(ExportExposure, WeighsLogarithmsOfLightByArea) {
    const float exposure = exposure_of({3, 1}, {Rgb(20), Rgb(320)});  // geometric mean: 40
    EXPECT_NEAR(displayed(40, exposure), 0.2, 1e-5);
}

TEST(ExportExposure, IgnoresTheDarkOutsideOfALitBuilding) {
    const float exposure = exposure_of({1, 100, 100}, {Rgb(100), Rgb(1e-6f), Rgb(0)});
    EXPECT_NEAR(displayed(100, exposure), 0.2, 1e-5);
}

TEST(ExportExposure, CountsDimSurfacesThatReflectMoreThanAHundredthOfTheLight) {
    const float exposure = exposure_of({1, 3}, {Rgb(100), Rgb(1)});  // geometric mean: 100^(1/4)
    EXPECT_NEAR(displayed(std::sqrt(10.0f), exposure), 0.2, 1e-5);
}

TEST(ExportExposure, IsZeroInTheDark) { EXPECT_EQ(exposure_of({1}, {Rgb(0)}), 0); }

}  // namespace
}  // namespace interflect
