// Lights and views of a glTF file, in its units: candela, lux, cd/m^2, radians.
//
// Seen to fail when the exitance lacks its factor of pi, when lights face along +z, when cones' angles stay in radians
// and when an orthographic view shows half of its height.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interflect/ray_caster.h"
#include "interflect/solve.h"
#include "tests/formats/gltf/builder.h"

namespace interflect {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using namespace testing_support;

using std::numbers::pi;

/// A file with a triangle and a light in a node that is turned by a quarter about x: -z of the node is +y.
GltfBuilder file_with_light(const json& light) {
    GltfBuilder file;
    file.add_triangle();
    const double half = std::numbers::sqrt2 / 2;
    file.add_node({{"name", "lamp"},
                   {"translation", {1, 2, 3}},
                   {"rotation", {half, 0, 0, half}},
                   {"scale", {2, 2, 2}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.file["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
    return file;
}

void expect_close(const V3f& found, const V3f& expected) { EXPECT_LT((found - expected).length(), 1e-6f) << found; }

TEST(GltfLights, PointsShineInCandela) {
    const Scene scene =
        file_with_light({{"type", "point"}, {"intensity", 50}, {"color", {1, 0.5, 0}}, {"range", 7}}).read();
    ASSERT_EQ(scene.luminaires.size(), 1u);
    EXPECT_EQ(scene.luminaires[0].name, "lamp");
    EXPECT_EQ(scene.objects[scene.luminaires[0].object], "lamp");
    const auto& light = std::get<PointLight>(scene.luminaires[0].kind);
    EXPECT_EQ(light.intensity, Rgb(50, 25, 0)) << "whatever the scale of its node";
    EXPECT_EQ(V3f(scene.origin) + light.position, V3f(1, 2, 3));
    EXPECT_THAT(warning_kinds(scene), testing::Contains("light-range"));
}

TEST(GltfLights, SpotsHaveAnglesInRadians) {
    const Scene scene =
        file_with_light(
            {{"type", "spot"}, {"intensity", 10}, {"spot", {{"innerConeAngle", pi / 9}, {"outerConeAngle", pi / 4}}}})
            .read();
    const auto& light = std::get<SpotLight>(scene.luminaires.at(0).kind);
    EXPECT_FLOAT_EQ(light.inner_angle, 20);
    EXPECT_FLOAT_EQ(light.outer_angle, 45);
    expect_close(light.direction, {0, 1, 0});
    EXPECT_EQ(light.intensity, Rgb(10));
}

/// Between the angles, the specification recommends ((cos a - cos outer) / (cos inner - cos outer))^2, as used here.
TEST(GltfLights, DefaultConeGoesFromTheAxisTo45Degrees) {
    const Scene scene = file_with_light({{"type", "spot"}}).read();
    const auto& light = std::get<SpotLight>(scene.luminaires.at(0).kind);
    EXPECT_EQ(light.inner_angle, 0);
    EXPECT_FLOAT_EQ(light.outer_angle, 45);
    EXPECT_EQ(light.intensity, Rgb(1));
}

TEST(GltfLights, DirectionalOnesShineInLux) {
    const Scene scene = file_with_light({{"type", "directional"}, {"intensity", 1000}}).read();
    const auto& light = std::get<DirectionalLight>(scene.luminaires.at(0).kind);
    EXPECT_EQ(light.irradiance, Rgb(1000));
    expect_close(light.direction, {0, 1, 0});
}

// A point light of I candela, h above a corner of the black triangle: E = I h / r^3, with distance r. The midpoint rule
// gives its mean over the triangle. About 16,000 rays arrive, so the standard error is below 1%.
TEST(GltfLights, APointLightGivesItsIlluminance) {
    constexpr double intensity = 100, height = 2;
    GltfBuilder file;
    file.add_triangle({{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}}});
    file.add_node({{"translation", {0, 0, height}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.file["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", intensity}}};
    const Scene scene = file.read();
    const Solution solution = solve(scene, RayCaster(scene), {.limits = {.rays = 2'000'000}});
    constexpr int steps = 200;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; i + k < steps; ++k, ++count) {
            const double x = (i + 1.0 / 3) / steps, y = (k + 1.0 / 3) / steps;
            sum += intensity * height / std::pow(x * x + y * y + height * height, 1.5);
        }
    EXPECT_NEAR(solution.irradiance.at(0).x, sum / count, 0.03 * sum / count);
}

TEST(GltfLights, EmissiveSurfacesHaveTheLuminanceOfTheirFactor) {
    GltfBuilder file;
    file.add_triangle({{"emissiveFactor", {1, 0.5, 0}},
                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 200}}}}}});
    const Scene scene = file.read();
    const auto exitance_of = [&](std::size_t patch) { return scene.materials[scene.patches[patch].material].exitance; };
    EXPECT_NEAR(exitance_of(0).x, 200 * pi, 1e-3);
    EXPECT_NEAR(exitance_of(0).y, 100 * pi, 1e-3);
    EXPECT_EQ(exitance_of(0).z, 0);
    EXPECT_EQ(exitance_of(1), Rgb(0)) << "the back of a surface that is not double-sided";
    file.file["materials"][0]["doubleSided"] = true;
    const Scene both = file.read();
    EXPECT_EQ(both.patches[1].material, both.patches[0].material);
}

TEST(GltfLights, MeasuredOnesFaceAlongMinusZ) {
    const std::string ies = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n500 0\n";
    GltfBuilder file;
    file.add_triangle();
    const double half = std::numbers::sqrt2 / 2;
    file.add_node({{"rotation", {half, 0, 0, half}},
                   {"extensions", {{"EXT_lights_ies", {{"light", 0}, {"multiplier", 2}, {"color", {1, 0, 0.5}}}}}}});
    file.file["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"bufferView", file.add_view(ies)}, {"mimeType", "application/x-ies-lm-63"}, {"name", "downlight"}}};
    const Scene scene = file.read();
    ASSERT_EQ(scene.luminaires.size(), 1u);
    EXPECT_EQ(scene.luminaires[0].name, "downlight");
    const auto& light = std::get<MeasuredLight>(scene.luminaires[0].kind);
    expect_close(light.direction, {0, 1, 0});
    expect_close(light.c0, {1, 0, 0});
    EXPECT_FALSE(light.mirrored);
    EXPECT_EQ(light.factor, Rgb(2, 0, 1));
    EXPECT_FLOAT_EQ(light.web->intensity({0, 0, -1}), 500);
}

TEST(GltfViews, PerspectiveCamerasLookAlongMinusZ) {
    GltfBuilder file;
    file.add_triangle();
    const double half = std::numbers::sqrt2 / 2;
    file.file["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", pi / 3}, {"znear", 0.1}}}}};
    file.add_node({{"name", "door"}, {"camera", 0}, {"translation", {1, 2, 3}}, {"rotation", {0, half, 0, half}}});
    file.add_node({{"name", "door"}, {"camera", 0}});
    const Scene scene = file.read();
    ASSERT_EQ(scene.views.size(), 2u);
    const View& view = scene.views[0];
    EXPECT_EQ(view.name, "door");
    EXPECT_EQ(scene.views[1].name, "door-2");
    EXPECT_EQ(view.eye, Imath::V3d(1, 2, 3));
    EXPECT_LT((view.look_at - Imath::V3d(0, 2, 3)).length(), 1e-12);
    expect_close(view.up, {0, 1, 0});
    EXPECT_FLOAT_EQ(view.fov, 60);
    EXPECT_EQ(view.extent, 0);
}

TEST(GltfViews, OrthographicCamerasShowTwiceTheirMagnification) {
    GltfBuilder file;
    file.add_triangle();
    file.file["cameras"] = {
        {{"type", "orthographic"}, {"name", "plan"}, {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"zfar", 9}}}}};
    file.add_node({{"camera", 0}});
    const Scene scene = file.read();
    EXPECT_EQ(scene.views.at(0).name, "plan");
    EXPECT_EQ(scene.views[0].extent, 6);
}

}  // namespace
}  // namespace interflect
