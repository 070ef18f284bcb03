// Points of emitting patches: uniform in solid angle near the patch, in area far from it. Seen to fail: the density of
// one triangle of two; the far density for near patches; angles of the plane triangle; a triangle chosen by area.
#include "interflect/render/lights/patch_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/render/lights/unoccluded_light.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

struct SeenPatchCase {
    const char* name;
    std::vector<V3f> corners;
    V3f x;
};
void PrintTo(const SeenPatchCase& seen, std::ostream* out) { *out << seen.name; }

Scene scene_of(const std::vector<V3f>& corners) {
    Scene scene;
    scene.objects = {""};
    scene.materials = {Material{"", Rgb(0), Rgb(1)}};
    scene.vertices = corners;
    Patch patch;
    for (std::uint32_t i = 0; i < corners.size(); ++i) patch.vertices[i] = i;
    scene.patches.push_back(patch);
    return scene;
}

class PatchPoints : public testing::TestWithParam<SeenPatchCase> {};
INSTANTIATE_TEST_SUITE_P(
    Views, PatchPoints,
    testing::Values(
        SeenPatchCase{"SquareFromACentimetre", {{0, 0, 1}, {0, 2, 1}, {2, 2, 1}, {2, 0, 1}}, {1.2f, 0.7f, 0.99f}},
        SeenPatchCase{"SquareBesideItsEdge", {{0, 0, 1}, {0, 2, 1}, {2, 2, 1}, {2, 0, 1}}, {2.05f, 0.7f, 0.9f}},
        SeenPatchCase{"SquareFromAfar", {{0, 0, 1}, {0, 2, 1}, {2, 2, 1}, {2, 0, 1}}, {1, 1, -9}},
        SeenPatchCase{"Trapezium", {{0, 0, 1}, {0.5f, 2, 1}, {1, 2, 1}, {3, 0, 1}}, {1, 1, 0.4f}},
        SeenPatchCase{"Triangle", {{0, 0, 1}, {0.2f, 2, 1.3f}, {3, 0.1f, 0.8f}}, {0.7f, 0.6f, 0.5f}},
        SeenPatchCase{"NarrowTriangle", {{0, 0, 1}, {0, 3, 1}, {0.02f, 1, 1}}, {0.3f, 1, 0.5f}}),
    testing::PrintToStringParamName());

/// The mean of cosine / density is the irradiance by Lambert's formula, from a plane that faces the patch and an
/// oblique one. The density of a direction is the same when it is found by chance.
TEST_P(PatchPoints, GiveTheIrradianceOfThePolygon) {
    const auto& [name, corners, x] = GetParam();
    RELEASE_ONLY_IF(std::string_view(name) != "SquareFromAfar" && std::string_view(name) != "Triangle");
    const Scene scene = scene_of(corners);
    const PatchGeometry patch(scene, scene.patches[0]);
    for (const V3f& n : {V3f(0, 0, 1), V3f(0.6f, 0.5f, 0.3f).normalized()}) {
        std::vector<double> values;
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            const auto words = random_words(17, i);
            const std::optional<PatchPoint> p = sample_patch(patch, x, unit_float(words[0]), unit_float(words[1]));
            ASSERT_TRUE(p);
            EXPECT_NEAR((patch.point(p->at) - x).length2() / p->distance2, 1, 1e-3);
            EXPECT_NEAR(patch_density(patch, x, p->direction, p->distance2) / p->density, 1, 1e-3);
            values.push_back(static_cast<double>(std::max(0.0f, n.dot(p->direction)) / p->density));
        }
        const double expected = static_cast<double>(polygon_irradiance(corners, x, n));
        EXPECT_GT(t_test(values, expected), false_alarm);
        EXPECT_LT(t_test(values, 1.1 * expected), false_alarm);
    }
}

/// Behind the lit side there is nothing to see.
TEST(PatchPoints, AreNoneBehindThePatch) {
    const Scene scene = scene_of({{0, 0, 1}, {0, 2, 1}, {2, 2, 1}, {2, 0, 1}});
    const PatchGeometry patch(scene, scene.patches[0]);
    EXPECT_FALSE(sample_patch(patch, V3f(1, 1, 2), 0.5f, 0.5f));
    EXPECT_EQ(patch_density(patch, V3f(1, 1, 2), V3f(0, 0, -1), 1), 0);
}

}  // namespace
}  // namespace interflect
