// Two closed rooms divided by one wall, with a lamp in the first. A corner of the wall is displaced by 1 mm. Rays start
// on the bilinear surface of a patch and hit two triangles: no light may leak where the two differ. Before the fix, the
// second room had 16% of the light of the first in a solution and 21% by path tracing.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/polygons/polygon.h"
#include "interflect/measure.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

const Imath::V3d in_lit_room(2, 2, 1), in_dark_room(6, 2, 1);

enum class Wall { polygon, patch };
void PrintTo(Wall wall, std::ostream* out) { *out << (wall == Wall::polygon ? "AsPolygon" : "AsPatch"); }

/// @param wall  polygon: added as readers do; patch: a warped patch, as callers of the library can make one.
Scene two_rooms(Wall wall) {
    Scene scene = closed_box({8, 4, 3}, 2, {Material{"", Rgb(0.7f), Rgb(0)}});
    add_rectangle(scene, {1.5f, 1.5f, 2.9f}, {0, 1, 0}, {1, 0, 0}, add_material(scene, Rgb(0), Rgb(1000)));
    const std::uint32_t material = add_material(scene, Rgb(0.7f), Rgb(0));
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const V3f& x : {V3f(4, 0, 0), V3f(4, 4, 0), V3f(4.001f, 4, 3), V3f(4, 0, 3)}) scene.vertices.push_back(x);
    if (wall == Wall::polygon) {
        const std::vector<std::vector<std::uint32_t>> loops = {{first, first + 1, first + 2, first + 3}};
        EXPECT_EQ(add_polygon(scene, loops, material, 0, true), PolygonResult::added);
        return scene;
    }
    const PatchIndex front(scene.patches.size());
    Patch patch{.vertices = {first, first + 1, first + 2, first + 3}, .material = material, .other_side = front + 1};
    scene.patches.push_back(patch);
    patch.vertices = {first, first + 3, first + 2, first + 1};
    patch.other_side = PatchIndex(front);
    scene.patches.push_back(patch);
    return scene;
}

class WarpedWall : public testing::TestWithParam<Wall> {};
INSTANTIATE_TEST_SUITE_P(Made, WarpedWall, testing::Values(Wall::polygon, Wall::patch),
                         testing::PrintToStringParamName());

/// Rays from both sides start on the bilinear surface of the wall and must not hit it.
TEST_P(WarpedWall, IsLeftByRaysThatStartOnIt) {
    const Scene scene = two_rooms(GetParam());
    const RayCaster ray_caster(scene);
    std::vector<Ray> rays;
    std::vector<std::uint32_t> sources;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        if (scene.patches[p].other_side == none) continue;
        const PatchGeometry geometry(scene, scene.patches[p]);
        for (int i = 0; i < 64; ++i)
            for (int j = 0; j < 64; ++j) {
                const Parameters at = geometry.uniform_parameters((static_cast<float>(i) + 0.5f) / 64,
                                                                  (static_cast<float>(j) + 0.5f) / 64);
                const V3f origin = geometry.point(at) + ray_caster.ray_offset(p) * geometry.normal();
                rays.push_back({origin, geometry.normal()});
                sources.push_back(p);
            }
    }
    std::vector<Hit> hits(rays.size());
    ray_caster.trace(rays, hits);
    int met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        met += hits[i].patch == none || scene.patches[hits[i].patch].other_side != none;
    EXPECT_EQ(met, 0);
}

/// The wall extends 1 mm into the ceiling of the second room, which is not cut there; elements spread that light.
TEST_P(WarpedWall, LeavesTheOtherRoomDark) {
    constexpr float spread = 1e-3f;  // relative to the light in the first room
    const Scene scene = two_rooms(GetParam());
    const RayCaster ray_caster(scene);
    Solution solution;
    for (const char* method : {"srr", "random-walk", "photon-mesh", "global-lines", "hsrr"}) {
        // One global line through that strip has a large contribution, so several are needed.
        const std::int64_t rays = std::string(method) == "global-lines" ? 400'000 : 100'000;
        solution = solve(scene, ray_caster, {.method = find_method(method), .limits = {.rays = rays}});
        const float lit = solution.irradiance[0].x;  // wall at x = 0
        EXPECT_GT(lit, 10) << method;
        for (std::uint32_t p = 4; p < 8; ++p)  // wall at x = 8
            EXPECT_LT(solution.irradiance[p].x, spread * lit) << method;
    }
    const std::array points{MeasuringPoint{in_lit_room}, MeasuringPoint{in_dark_room}};
    const auto measured = [&](const Solution* known) {
        return measure_irradiance(scene, known, ray_caster, points,
                                  {.shading = known ? Shading::gather : Shading::path, .samples = 2048});
    };
    const std::vector<MeasuredIrradiance> traced = measured(nullptr), gathered = measured(&solution);
    EXPECT_GT(traced[0].sum().x, 10);
    EXPECT_EQ(traced[1].sum().x, 0);
    EXPECT_LT(gathered[1].sum().x, spread * gathered[0].sum().x);
}

}  // namespace
}  // namespace interflect
