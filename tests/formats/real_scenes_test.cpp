// Real scenes of the 1990s. The numbers were counted independently: faces by number of vertices with awk, areas and
// powers with a 30-line Python script that supports only v, p, m, ed, f and the scale of xf.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/load.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

Scene load(const std::string& name) {
    Scene scene = load_scene(testing_support::real_scenes() / name);
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
    EXPECT_EQ(scene.files.size(), 1u);
    return scene;
}

std::size_t triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Patch& p : scene.patches) count += p.is_triangle();
    return count;
}
double scene_area(const Scene& scene) {
    double sum = 0;
    for (const Patch& p : scene.patches) sum += patch_area(scene, p);
    return sum;
}
double luminous_power(const Scene& scene) {
    double sum = 0;
    for (const Patch& p : scene.patches)
        sum += static_cast<double>(patch_area(scene, p)) * luminance(scene.materials[p.material].exitance);
    return sum;
}
std::int64_t warning_count(const Scene& scene, const std::string& kind) {
    std::int64_t count = 0;
    for (const auto& entry : scene.warnings.entries())
        if (entry.kind == kind) count += entry.count;
    return count;
}

TEST(RealScenes, Cube) {
    const Scene scene = load("cube.mgf");
    EXPECT_EQ(scene.patches.size(), 2u * (65 + 1));
    EXPECT_EQ(triangles(scene), 2u * 65);
    EXPECT_NEAR(scene_area(scene), 1456.49601, 1e-3);
    EXPECT_NEAR(luminous_power(scene), 400'000, 1);  // two sides of 1 m2 with 200,000 lm/m2
    EXPECT_EQ(warning_count(scene, "specular-reflection"), 7);
}

TEST(RealScenes, Office2) {
    const Scene scene = load("office2.mgf");
    // 103 triangles and 319 quadrilaterals: one of them is one-sided, and 8 are warped and become 16 triangles.
    EXPECT_EQ(scene.patches.size(), 2u * (421 + 8) + 1);
    EXPECT_EQ(triangles(scene), 2u * (103 + 16));
    EXPECT_NEAR(scene_area(scene), 217.59212, 1e-4);  // 0.00023 more than with flat areas for the warped ones
    EXPECT_NEAR(luminous_power(scene), 2600, 0.01);
}

TEST(RealScenes, Corridor) {
    const Scene scene = load("corridor.mgf");
    // Floor and ceiling (7 triangles in all), 5 walls, 57 lamps, a leaf of 2 triangles and a quadrilateral, 2
    // cylinders, the ring on the wall, the ball with 2 x 16 triangles at its poles.
    EXPECT_EQ(scene.patches.size(), 2u * (7 + 5 + 57 + 3 + 2 * 16 + 16 * 16 + 16 * 8));
    EXPECT_EQ(triangles(scene), 2u * (7 + 2 + 2 * 16));
    EXPECT_NEAR(luminous_power(scene), 2 * 57 * 0.4 * 0.4 * 250'000, 10);
    EXPECT_EQ(scene.objects.size(), 30u);
}

TEST(RealScenes, OfficeGraz) {
    const Scene scene = load("office-graz.mgf");
    // 13,258 faces of 4 vertices: 137 name one twice, 141 are concave; 519 of 3; two of 6; one of 8; one disk (ring).
    const std::size_t front_triangles = 137 + 2 * 141 + 519 + 2 * 4 + 6 + 16;
    EXPECT_EQ(triangles(scene), 2 * front_triangles);
    EXPECT_EQ(scene.patches.size(), 2 * (13'258 - 137 - 141 + front_triangles));
    EXPECT_NEAR(scene_area(scene), 749.778607 + 2 * 16 * 0.5 * std::sin(std::numbers::pi / 8) * 0.019 * 0.019, 0.001);
    EXPECT_NEAR(luminous_power(scene), 4 * 2 * 2 * 0.2 * 1.5 * 1874, 0.1);
    EXPECT_EQ(warning_count(scene, "unsupported-entity"), 3);
    EXPECT_EQ(warning_count(scene, "degenerate-face"), 0);
    EXPECT_EQ(warning_count(scene, "unclosed-object") + warning_count(scene, "unbalanced-object"), 0);
}

TEST(RealScenes, FloorGloss) {
    const Scene scene = load("floor_gloss.mgf");
    EXPECT_EQ(scene.patches.size(), 2u * (8 + 128));
    // The lamp is 0.2 m by 0.2 sqrt(2) m.
    EXPECT_NEAR(luminous_power(scene), 2 * 0.2 * 0.2 * std::sqrt(2.0) * 10'000, 0.01);
}

TEST(RealScenes, Examp1) {
    const Scene scene = load("examp1.mgf");
    // All one-sided. Twice, because the array mirrors it: a lamp of 16, a case of 12, two prisms of 15 corners, and a
    // reflector of 2 + 5. Then 15 vanes of 4. A prism has 15 walls and two ends.
    std::size_t ends = 0;
    for (const Patch& p : scene.patches) {
        EXPECT_EQ(p.other_side, none);
        ends += p.is_triangle();
    }
    EXPECT_EQ(scene.patches.size() - ends, 2u * (16 + 12 + 2 * 15 + 7) + 15 * 4);
    EXPECT_EQ(ends, 2u * 2 * 2 * 13);
    // The lamps' fronts face away from their axes (y = +-1 in, z = 1.25 in), on both sides of the mirror.
    for (const Patch& p : scene.patches) {
        if (largest_channel(scene.materials[p.material].exitance) == 0) continue;
        const PatchGeometry lamp(scene, p);
        const float axis = lamp.centre().y > 0 ? 0.0254f : -0.0254f;
        EXPECT_GT(lamp.normal().dot(lamp.centre() - V3f(0, axis, 1.25f * 0.0254f)), 0);
    }
}

/// The flux comes from a 20-line Python script: bilinear intensities at 1800 x 180 midpoints.
TEST(RealScenes, LuminaireOfTheExampleHasItsFlux) {
    Warnings warnings;
    const PhotometricWeb web = load_photometric_web(testing_support::real_scenes() / "examp1.ies", {}, warnings);
    EXPECT_NEAR(web.flux() / 5296.656, 1, 1e-6);
    EXPECT_EQ(web.lamp_lumens, 5800);
    EXPECT_LT((web.opening.size - 0.3048f * V3f(4.04f, 0.85f, 0.292f)).length(), 1e-6f);
    ASSERT_EQ(warnings.entries().size(), 1u);
    EXPECT_EQ(warnings.entries()[0].kind, "ies-version");
}

}  // namespace
}  // namespace interflect
