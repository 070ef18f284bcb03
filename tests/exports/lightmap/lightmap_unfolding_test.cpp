#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/render/smooth/smooth_field.h"
#include "tests/exports/lightmap/lightmaps.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace lightmap_testing;

/// Parameters from 0 to 1.
using CurvedSurface = V3f (*)(float u, float v);

/// Triangles, two per grid cell, or one if two corners coincide. @param pairs  Planar cells stay undivided.
Scene tessellated(CurvedSurface surface, int columns, int rows, bool pairs) {
    Scene scene;
    scene.objects = {""};
    const std::uint32_t material = testing_support::add_material(scene, Rgb(0.5f), Rgb(0));
    const auto add = [&](std::vector<V3f> corners) {
        Patch patch;
        patch.material = material;
        for (std::size_t c = 0; c < corners.size(); ++c) {
            if ((corners[c] - corners[(c + 1) % corners.size()]).length() < 1e-5f) {
                if (corners.size() == 3) return;
                corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(c));
            }
        }
        for (std::size_t c = 0; c < corners.size(); ++c) {
            patch.vertices[c] = static_cast<std::uint32_t>(scene.vertices.size());
            scene.vertices.push_back(corners[c]);
        }
        scene.patches.push_back(patch);
    };
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j) {
            const auto at = [&](int a, int b) {
                return surface(static_cast<float>(i + a) / static_cast<float>(columns),
                               static_cast<float>(j + b) / static_cast<float>(rows));
            };
            if (pairs) {
                add({at(0, 0), at(1, 0), at(1, 1)});
                add({at(0, 0), at(1, 1), at(0, 1)});
            } else {
                add({at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
            }
        }
    return scene;
}

V3f around(float turns, float radius, float height) {
    const float angle = 2 * std::numbers::pi_v<float> * turns;
    return {radius * std::cos(angle), radius * std::sin(angle), height};
}

V3f cylinder(float u, float v) { return around(u, 0.5f, v); }
V3f cone(float u, float v) { return around(u, 1 - v, v); }
V3f sphere(float u, float v) {
    const float latitude = std::numbers::pi_v<float> * (v - 0.5f);
    return around(u, std::cos(latitude), std::sin(latitude));
}
/// Two and a half turns, which overlap when unfolded.
V3f ramp(float u, float v) { return around(2.5f * u, 2 - v, 2 * u); }
/// Circles around the middle of a saddle are longer than in the plane.
V3f saddle(float u, float v) {
    return {2 * u - 1, 2 * v - 1, 4 * (u - 0.5f) * (u - 0.5f) - 4 * (v - 0.5f) * (v - 0.5f)};
}

struct UnfoldedCase {
    const char* name;
    CurvedSurface surface;
    int columns, rows;
    bool pairs;
    std::size_t max_charts;
    double stretch;  // of edges
};
void PrintTo(const UnfoldedCase& unfolded, std::ostream* out) { *out << unfolded.name; }

class UnfoldedLightmap : public testing::TestWithParam<UnfoldedCase> {
  protected:
    const Scene scene_ = tessellated(GetParam().surface, GetParam().columns, GetParam().rows, GetParam().pairs);
    const std::vector<LightmapChart> charts_ =
        make_charts(scene_, std::vector<bool>(scene_.patches.size(), true), *at(50).lightmap);
};

// Fails if smooth surfaces are not joined.
TEST_P(UnfoldedLightmap, HasFewCharts) {
    EXPECT_LE(charts_.size(), GetParam().max_charts);
    std::size_t patches = 0;
    for (const LightmapChart& chart : charts_) patches += chart.patches.size();
    EXPECT_EQ(patches, scene_.patches.size());
}

// Fails without has_room().
TEST_P(UnfoldedLightmap, OverlapsNowhere) {
    for (const LightmapChart& chart : charts_)
        for (std::size_t i = 0; i < chart.patches.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) ASSERT_GT(separation(chart.patches[i], chart.patches[j]), -1e-4);
}

// Exact on developable surfaces. Fails with hinges that turn the wrong way, and with pieces that give way more.
TEST_P(UnfoldedLightmap, KeepsLengths) {
    for (const LightmapChart& chart : charts_)
        for (const FlatPatch& flat : chart.patches) {
            const Patch& patch = scene_.patches[flat.patch];
            EXPECT_GT(flat.signed_area(), 0);
            for (int c = 0; c < flat.count; ++c) {
                const int next = (c + 1) % flat.count;
                const double length =
                    (scene_.vertices[patch.vertices[c]] - scene_.vertices[patch.vertices[next]]).length();
                const auto corner = [&](int k) { return flat.corners[static_cast<std::size_t>(k)]; };
                EXPECT_NEAR((corner(next) - corner(c)).length() / length, 1, GetParam().stretch + 1e-3);
            }
        }
}

// At the edge of a facet, the light equals smooth shading, which both neighbours share. There are hence no seams, with
// or without a common chart. Turns of the ramp have separate light. Fails with layouts that place patches near others
// that are far in space.
TEST_P(UnfoldedLightmap, HasContinuousLight) {
    const Solution solution = solution_of(scene_, GetParam().pairs ? 1 : 2, [](const V3f& x) {
        return Rgb(100 + 10 * std::sin(x.x) + 10 * std::cos(x.y) + 20 * std::sin(x.z));
    });
    const Lightmap lightmap = make_lightmap(scene_, solution, at(50));
    const ElementVertices vertices(scene_, *solution.forest);
    const SmoothField smooth(*solution.forest, vertices, solution.irradiance);
    for (PatchIndex p{0}; p < scene_.patches.size(); ++p)
        for (std::uint64_t i = 0; i < 40; ++i) {
            const Parameters place = random_place(solution.forest->geometry(p), i);
            ASSERT_NEAR(sample(lightmap, p, place).x / smooth.at(p, place).x, 1, 0.005) << p;
        }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, UnfoldedLightmap,
                         testing::Values(UnfoldedCase{"Cylinder", cylinder, 24, 3, false, 4, 0},
                                         UnfoldedCase{"CylinderOfTriangles", cylinder, 24, 3, true, 4, 0},
                                         UnfoldedCase{"Cone", cone, 32, 4, false, 5, 0},
                                         UnfoldedCase{"Sphere", sphere, 24, 12, false, 20, 0.1},
                                         UnfoldedCase{"SphereOfTriangles", sphere, 24, 12, true, 40, 0.1},
                                         UnfoldedCase{"Ramp", ramp, 80, 2, true, 12, 0.1},
                                         UnfoldedCase{"Saddle", saddle, 12, 12, true, 20, 0.1}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace interflect
