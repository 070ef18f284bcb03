#include "interflect/exports/mesh/element_mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/render/smooth/smooth_field.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::closed_box;

const Material grey{"grey", Rgb(0.5f), Rgb(0)};

Scene in_triangles(Scene scene) {
    const std::vector<Patch> quadrilaterals = std::exchange(scene.patches, {});
    for (const Patch& patch : quadrilaterals)
        for (const std::size_t second : {1, 2}) {
            Patch half = patch;
            half.vertices = {patch.vertices[0], patch.vertices[second], patch.vertices[second + 1], none};
            scene.patches.push_back(half);
        }
    return scene;
}

/// Down to eight levels, to put large leaves beside small ones everywhere.
void subdivide_at_random(ElementForest& forest) {
    constexpr int deepest = 8;
    for (ElementIndex e{0}; e < forest.size(); ++e)
        if (forest.level(e) < deepest && random_double(7, e) < (forest.level(e) < 2 ? 0.9 : 0.35)) forest.subdivide(e);
    forest.put_in_order(forest.patch_count());
}

class ElementMeshOf : public testing::TestWithParam<bool> {  // with triangles
  protected:
    ElementMeshOf() : scene(closed_box(V3f(1.1f, 2.3f, 3.7f), 3, {grey})) {
        if (GetParam()) scene = in_triangles(std::move(scene));
        forest.emplace(scene, 1 << 20);
        subdivide_at_random(*forest);
        for (ElementIndex e{0}; e < forest->size(); ++e)
            irradiance.emplace_back(static_cast<float>(random_double(11, e)), 1.0f, 2.0f);
    }
    std::vector<MeshTriangle> triangles_of(ElementMesh& mesh, ElementIndex leaf) const {
        std::vector<MeshTriangle> triangles;
        mesh.triangulate(leaf, triangles);
        return triangles;
    }

    Scene scene;
    std::optional<ElementForest> forest;
    std::vector<Rgb> irradiance;
};

// A closed surface has no crack if every edge of a triangle belongs to exactly one other triangle, in the opposite
// direction. Fails without add_points_on_edge(), and without join_near_points().
TEST_P(ElementMeshOf, ClosedBoxIsWatertight) {
    ElementMesh mesh(scene, *forest, irradiance);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const ElementIndex leaf : forest->leaves())
        for (const MeshTriangle& triangle : triangles_of(mesh, leaf))
            for (std::size_t c = 0; c < 3; ++c) ++edges[{triangle[c].point, triangle[(c + 1) % 3].point}];
    EXPECT_GT(edges.size(), 10'000);
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_TRUE(edges.contains({edge.second, edge.first})) << edge.first << " " << edge.second;
    }
}

TEST_P(ElementMeshOf, TrianglesCoverEachLeaf) {
    ElementMesh mesh(scene, *forest, irradiance);
    for (const ElementIndex leaf : forest->leaves()) {
        const V3f& normal = forest->geometry(forest->patch(leaf)).normal();
        double area = 0;
        for (const MeshTriangle& triangle : triangles_of(mesh, leaf)) {
            const auto x = [&](std::size_t c) { return mesh.points()[triangle[c].point]; };
            area += (x(1) - x(0)).cross(x(2) - x(0)).dot(normal) / 2;
        }
        ASSERT_NEAR(area, forest->area(leaf), 1e-3 * forest->area(leaf) + 1e-6);
    }
}

TEST_P(ElementMeshOf, CornersHaveTheIrradianceOfSmoothShading) {
    ElementMesh mesh(scene, *forest, irradiance);
    const ElementVertices vertices(scene, *forest);
    const SmoothField smooth(*forest, vertices, irradiance);
    for (const ElementIndex leaf : forest->leaves())
        for (const MeshTriangle& triangle : triangles_of(mesh, leaf))
            for (const MeshCorner& corner : triangle) {
                const Rgb expected = smooth.at(forest->patch(leaf), corner.at);
                for (int k = 0; k < 3; ++k) ASSERT_NEAR(corner.irradiance[k], expected[k], 1e-4);
            }
}

INSTANTIATE_TEST_SUITE_P(Quadrilaterals, ElementMeshOf, testing::Values(false), testing_support::printed_name);
INSTANTIATE_TEST_SUITE_P(Triangles, ElementMeshOf, testing::Values(true), testing_support::printed_name);

}  // namespace
}  // namespace interflect
