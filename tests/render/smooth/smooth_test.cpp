#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/surfaces/smooth_surfaces.h"
#include "interflect/render/smooth/element_vertices.h"
#include "interflect/render/smooth/smooth_field.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::add_material;
using testing_support::add_rectangle;

const Rgb unlit(0, 0, 0), white(1, 1, 1), dark(0.1f, 0.2f, 0.3f), bright(4, 5, 6);

Rgb linear_field(const V3f& x) { return Rgb(1, 2, 3) + Rgb(4, 0, 1) * x.x + Rgb(0, 5, 2) * x.y; }

std::vector<Rgb> at_centres(const Scene& scene) {
    std::vector<Rgb> values;
    for (const Patch& patch : scene.patches) values.push_back(linear_field(PatchGeometry(scene, patch).centre()));
    return values;
}

void expect_near(const Rgb& found, const Rgb& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5);
}

/// n x n squares over the unit square of the plane z = 0, facing +z.
Scene grid(int n, bool two_sided = false) {
    Scene scene;
    add_rectangle(scene, V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), add_material(scene, white * 0.5f, unlit), n, n,
                  two_sided);
    return scene;
}

/// Alternates the direction of the diagonal.
Scene triangle_grid(int n) {
    Scene scene = grid(n);
    const std::vector<Patch> squares = std::move(scene.patches);
    scene.patches.clear();
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const auto& v = squares[i].vertices;
        Patch a = squares[i], b = squares[i];
        a.vertices = i % 2 ? std::array{v[0], v[1], v[2], none} : std::array{v[0], v[1], v[3], none};
        b.vertices = i % 2 ? std::array{v[0], v[2], v[3], none} : std::array{v[1], v[2], v[3], none};
        scene.patches.push_back(a);
        scene.patches.push_back(b);
    }
    return scene;
}

Scene unwelded(const Scene& scene) {
    Scene copy = scene;
    copy.vertices.clear();
    for (Patch& patch : copy.patches)
        for (int c = 0; c < patch.vertex_count(); ++c) {
            copy.vertices.push_back(scene.vertices[patch.vertices[c]]);
            patch.vertices[c] = static_cast<std::uint32_t>(copy.vertices.size() - 1);
        }
    return copy;
}

/// Two unit squares that share the edge from (0, 0, 0) to (0, 1, 0); the second is turned up about it by `degrees`.
Scene hinge(float degrees, bool same_material = true) {
    Scene scene;
    const std::uint32_t first = add_material(scene, white * 0.5f, unlit);
    const std::uint32_t second = same_material ? first : add_material(scene, white * 0.4f, unlit);
    const float angle = degrees * 3.14159265f / 180;
    add_rectangle(scene, V3f(-1, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), first);
    add_rectangle(scene, V3f(0, 0, 0), V3f(std::cos(angle), 0, std::sin(angle)), V3f(0, 1, 0), second);
    return scene;
}

/// Undivided patches: element i is patch i.
class SmoothPatches {
  public:
    SmoothPatches(const Scene& scene, const std::vector<Rgb>& values, const SmoothingOptions& options = {})
        : forest_(scene, scene.patches.size()),
          vertices_(scene, forest_, options),
          field_(forest_, vertices_, values) {}

    Rgb at(PatchIndex patch, Parameters p) const { return field_.at(patch, p); }

  private:
    ElementForest forest_;
    ElementVertices vertices_;
    SmoothField field_;
};

/// Returns the irradiance of hinge()'s dark first square at the edge to the bright second one.
Rgb at_hinge(const Scene& scene, const SmoothingOptions& options = {}) {
    return SmoothPatches(scene, std::vector{dark, bright}, options).at(PatchIndex(0), {1, 0.5f});
}

TEST(SmoothPatches, ReproducesALinearFieldInsideAGrid) {
    for (const Scene& scene : {grid(4), unwelded(grid(4))}) {
        const SmoothPatches smooth(scene, at_centres(scene));
        for (const PatchIndex patch : {PatchIndex(5), PatchIndex(6), PatchIndex(9), PatchIndex(10)})  // inner patches
            for (const Parameters p : {Parameters{0, 0}, {1, 1}, {0.3f, 0.8f}, {0.5f, 0.1f}}) {
                const V3f x = PatchGeometry(scene, scene.patches[patch]).point(p);
                expect_near(smooth.at(patch, p), linear_field(x));
            }
    }
}

/// If neighbours compute a shared point from their own corners, the last bits differ.
TEST(SmoothSurfaces, VerticesThatDifferByRoundingAreOne) {
    Scene scene = unwelded(grid(8));
    for (std::size_t i = 0; i < scene.vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            scene.vertices[i][axis] += static_cast<float>(static_cast<int>(i * 7 + axis) % 5 - 2) * 0x1p-24f;
    EXPECT_EQ(find_smooth_surfaces(scene).corners.count, 81u);
    scene.vertices[0].x += 1e-4f;  // a corner of the whole grid, still within its patch: a vertex of its own as before
    scene.vertices[1].x += 1e-4f;  // the other end of that patch's first edge leaves its neighbour's corner
    EXPECT_EQ(find_smooth_surfaces(scene).corners.count, 82u);
}

TEST(SmoothPatches, IsContinuousAcrossPatchesEverywhere) {
    for (const Scene& scene : {grid(4), triangle_grid(4)}) {
        std::vector<Rgb> values;
        for (std::size_t i = 0; i < scene.patches.size(); ++i) values.push_back(white * static_cast<float>(i * i % 11));
        const SmoothPatches smooth(scene, values);
        // Every patch with the point returns the same value; the points lie on vertical grid lines.
        for (const float y : {0.1f, 0.25f, 0.4f, 0.9f})
            for (const float x : {0.25f, 0.5f, 0.75f}) {
                std::set<int> answers;  // to 1e-4
                int patches = 0;
                for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
                    const PatchGeometry geometry(scene, scene.patches[i]);
                    const Parameters p = geometry.parameters_of(V3f(x, y, 0));
                    if ((geometry.point(p) - V3f(x, y, 0)).length() > 1e-6f) continue;
                    ++patches;
                    answers.insert(static_cast<int>(std::lround(smooth.at(i, p).x * 1e4f)));
                }
                EXPECT_GE(patches, 2);
                EXPECT_EQ(answers.size(), 1u) << "at " << x << ", " << y;
            }
    }
}

/// Four quarters of a square around one vertex. One is cut in two there, which must not double its weight: the mean of
/// the vertex's basis function is 1/4 over a quarter, and 1/3 over each half of one.
TEST(SmoothPatches, CuttingAPatchInTwoDoesNotDoubleItsWeight) {
    const std::vector<Rgb> whole{bright, dark, dark, dark};
    Scene cut = grid(2);
    const Rgb expected = SmoothPatches(cut, whole).at(PatchIndex(3), {0, 0});
    Patch half = cut.patches[0];
    cut.patches[0].vertices = {half.vertices[0], half.vertices[1], half.vertices[2], none};
    half.vertices = {half.vertices[0], half.vertices[2], half.vertices[3], none};
    cut.patches.push_back(half);
    expect_near(SmoothPatches(cut, std::vector{bright, dark, dark, dark, bright}).at(PatchIndex(3), {0, 0}),
                (bright * 4 + dark * 9) / 13);
    expect_near(expected, (bright + dark * 3) / 4);
}

TEST(SmoothPatches, ALonePatchKeepsItsValue) {
    const SmoothPatches smooth(grid(1), std::vector{bright});
    for (const Parameters p : {Parameters{0, 0}, {0.25f, 0.75f}, {1, 1}})
        expect_near(smooth.at(PatchIndex(0), p), bright);
}

TEST(SmoothPatches, StopsAtCreases) {
    expect_near(at_hinge(hinge(90)), dark);
    expect_near(at_hinge(hinge(31)), dark);
    expect_near(at_hinge(hinge(29)), (dark + bright) / 2);
    expect_near(at_hinge(hinge(0)), (dark + bright) / 2);
    expect_near(at_hinge(hinge(40), {.crease_angle = 45}), (dark + bright) / 2);
}

TEST(SmoothPatches, StopsAtBordersOfMaterials) { expect_near(at_hinge(hinge(0, false)), dark); }

/// Squares that touch at one corner only share no edge, so light of one does not spread to the other.
TEST(SmoothPatches, DoesNotPassThroughASharedCorner) {
    Scene scene = grid(2);
    scene.patches = {scene.patches[0], scene.patches[3]};
    expect_near(SmoothPatches(scene, std::vector{dark, bright}).at(PatchIndex(0), {1, 1}), dark);
}

/// Coincident faces share edges, but run along them in the same direction, so one does not continue the other.
TEST(SmoothPatches, CoincidentPatchesDoNotShadeIntoEachOther) {
    Scene scene = grid(1);
    scene.patches.push_back(scene.patches[0]);
    const SmoothPatches smooth(scene, std::vector{dark, bright});
    expect_near(smooth.at(PatchIndex(0), {0, 0.5f}), dark);
    expect_near(smooth.at(PatchIndex(1), {1, 1}), bright);
}

TEST(SmoothPatches, KeepsTheSidesOfAFaceApart) {
    const Scene scene = grid(3, true);
    std::vector<Rgb> values;
    for (std::size_t i = 0; i < scene.patches.size(); ++i) values.push_back(i % 2 ? bright : dark);
    const SmoothPatches smooth(scene, values);
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) expect_near(smooth.at(i, {0.2f, 0.9f}), values[i]);
}

/// A front joins the neighbour's front even if the neighbour's vertices have the opposite order, so that its front is
/// the second patch in the file.
TEST(SmoothPatches, FollowsTheOrientationOfSidesNotTheirOrder) {
    Scene scene = grid(2, true);
    std::swap(scene.patches[2].vertices, scene.patches[3].vertices);  // the back of face 1 comes first
    std::vector<Rgb> values(8, dark);
    values[3] = bright;  // its front
    const SmoothPatches smooth(scene, values);
    expect_near(smooth.at(PatchIndex(0), {1, 0}),
                (dark + bright) / 2);                     // front of face 0, at the edge of faces 0 and 1
    expect_near(smooth.at(PatchIndex(1), {0, 1}), dark);  // its back
}

TEST(SmoothSurfaces, OneForEachVertexOfASmoothGrid) {
    EXPECT_EQ(find_smooth_surfaces(grid(4)).corners.count, 25u);
    EXPECT_EQ(find_smooth_surfaces(triangle_grid(4)).corners.count, 25u);
    EXPECT_EQ(find_smooth_surfaces(grid(4, true)).corners.count, 50u);
    EXPECT_EQ(find_smooth_surfaces(hinge(90)).corners.count, 8u);
    EXPECT_EQ(find_smooth_surfaces(triangle_grid(1)).corners.group[3], none);
}

TEST(SmoothSurfaces, AnEdgeOfVeryManyPatchesIsACrease) {
    Scene scene = hinge(0);
    for (int i = 0; i < 2000; ++i) scene.patches.push_back(scene.patches[1]);
    EXPECT_EQ(find_smooth_surfaces(scene).corners.count, 4 * 2002u);
}

/// n (n + 1) edges along each axis; a divided square also has its diagonal.
TEST(SmoothSurfaces, HaveOneEdgeForBothNeighbours) {
    EXPECT_EQ(find_smooth_surfaces(grid(4)).edges.count, 2 * 4 * 5u);
    EXPECT_EQ(find_smooth_surfaces(triangle_grid(4)).edges.count, 2 * 4 * 5 + 4 * 4u);
    EXPECT_EQ(find_smooth_surfaces(grid(4, true)).edges.count, 2 * 2 * 4 * 5u);
    EXPECT_EQ(find_smooth_surfaces(hinge(0)).edges.count, 7u);
    EXPECT_EQ(find_smooth_surfaces(hinge(90)).edges.count, 8u);
}

TEST(SmoothPatches, RefusesAWrongNumberOfValues) {
    EXPECT_THROW(SmoothPatches(grid(2), std::vector{bright}), InputError);
}

}  // namespace
}  // namespace interflect
