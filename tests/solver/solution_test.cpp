// leaves() is the mesh of a solution: it covers every patch once, in world coordinates, with the solution's values.
// Seen to fail if an inner element is listed, if the origin is not added, and if the third corner of a quadrilateral is
// missing. The const functions of a solver may be called from several threads.

#include "interflect/solution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

const View into_the_room{"corner", {0.9f, 1.9f, 2.5f}, {0.1f, 0.4f, 0.2f}, {0, 0, 1}, 40};

/// Returns the furnished room far from the origin of the world, with a triangle in it.
Scene distant_room() {
    Scene scene = furnished_room();
    scene.origin = {4e5, -3e5, 120};
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.insert(scene.vertices.end(), {{0.2f, 0.5f, 2}, {0.6f, 0.5f, 2}, {0.2f, 1.4f, 2.2f}});
    scene.patches.push_back({.vertices = {first, first + 1, first + 2, none}});
    return scene;
}

Solution solved(const Scene& scene, bool shrinkage = true) {
    SolveOptions options{.method = find_method("ihsrr"), .views = {{into_the_room}}, .limits = {.rays = 300'000}};
    options.views[0].view.eye += scene.origin;
    options.views[0].view.look_at += scene.origin;
    options.experimental.shrinkage = shrinkage;
    return solve(scene, RayCaster(scene), options);
}

Imath::V3d twice_the_area(const Leaf& leaf) {
    Imath::V3d sum(0, 0, 0);
    for (int k = 1; k + 1 < leaf.vertex_count; ++k)
        sum += (leaf.vertices[k] - leaf.vertices[0]).cross(leaf.vertices[k + 1] - leaf.vertices[0]);
    return sum;
}

/// Noise reduction only changes the finished solution, so a run without it has the same light as a run before it.
TEST(Solution, KeepsTheIrradianceBeforeNoiseReduction) {
    const Scene scene = distant_room();
    const Solution solution = solved(scene), expected = solved(scene, /*shrinkage=*/false);
    ASSERT_EQ(solution.forest->subdivided(), expected.forest->subdivided());
    EXPECT_TRUE(expected.unreduced_irradiance.empty());
    ASSERT_EQ(solution.unreduced_irradiance.size(), expected.irradiance.size());
    for (std::size_t e = 0; e < expected.irradiance.size(); ++e)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(solution.unreduced_irradiance[e][c], expected.irradiance[e][c],
                        1e-4f * expected.irradiance[0][c]);
    EXPECT_NE(solution.unreduced_irradiance, solution.irradiance);
}

TEST(Leaves, CoverEveryPatchOnce) {
    const Scene scene = distant_room();
    const Solution solution = solved(scene);
    std::vector<double> area(scene.patches.size(), 0), power(scene.patches.size(), 0);
    int deepest = 0;
    for (const Leaf& leaf : leaves(scene, solution)) {
        const Patch& patch = scene.patches[leaf.patch];
        EXPECT_EQ(leaf.vertex_count, patch.vertex_count());
        EXPECT_NEAR(twice_the_area(leaf).length() / 2, leaf.area, 1e-4 * leaf.area);
        area[leaf.patch] += leaf.area;
        power[leaf.patch] += static_cast<double>(leaf.area) * leaf.irradiance.x;
        deepest = std::max(deepest, leaf.level);
    }
    EXPECT_GT(deepest, 1);
    for (std::uint32_t i = 0; i < area.size(); ++i) {
        const double whole = solution.forest->area(ElementIndex(i));
        EXPECT_NEAR(area[i], whole, 1e-4 * whole);
        EXPECT_NEAR(power[i], whole * solution.irradiance[i].x, 1e-3 * whole * solution.irradiance[i].x + 1e-9);
    }
}

TEST(Leaves, AreInTheWorld) {
    const Scene scene = distant_room();
    for (const Leaf& leaf : leaves(scene, solved(scene))) {
        const Imath::V3d corner = leaf.vertices[0] - scene.origin;
        EXPECT_LT(corner.length(), 5.6);  // of the room, 4 x 3 x 2.5 m
        EXPECT_GE(leaf.importance, 0);
        EXPECT_TRUE(std::isfinite(leaf.standard_error));
    }
}

TEST(Leaves, OfAnotherSceneAreRefused) {
    const Scene scene = distant_room();
    EXPECT_THROW(leaves(colourful_box(), solved(scene)), InputError);
}

TEST(Solver, SharedSolutionsOutliveChanges) {
    std::shared_ptr<const Solution> kept;
    std::vector<Rgb> irradiance;
    {
        Solver solver(furnished_room(), {.limits = {.rays = 100'000}});
        solver.advance({.rays = 10'000});
        kept = solver.shared_solution();
        irradiance = kept->irradiance;
        EXPECT_EQ(kept, solver.shared_solution()) << "made once";
        solver.advance({});
        EXPECT_NE(kept, solver.shared_solution());
        EXPECT_NE(irradiance, solver.solution().irradiance);
    }
    EXPECT_EQ(kept->irradiance, irradiance);
    EXPECT_EQ(kept->forest->size(), irradiance.size()) << "a forest of its own";
}

}  // namespace
}  // namespace interflect
