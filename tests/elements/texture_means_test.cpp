// Means of textures over cells: a parent's is the area-weighted mean of its children's, on patches of every shape.
//
// Seen to fail when triangles are weighted by parameters instead of areas, and when a triangle of a square is
// omitted.
#include "interflect/elements/texture_means.h"

#include <gtest/gtest.h>

#include "interflect/base/numbers/random.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

struct Shape {
    const char* name;
    std::array<V3f, 4> corners;
    std::array<V2f, 4> coordinates;
    bool is_triangle = false;
    float tolerance = 2e-5f;  // of the mean of four children
};
std::ostream& operator<<(std::ostream& out, const Shape& shape) { return out << shape.name; }

constexpr float any = 0;
const Shape shapes[] = {
    {"Triangle",
     {V3f(0, 0, 0), {3, 0, 1}, {1, 2, 0}, {any, any, any}},
     {V2f(0.1f, 0.2f), {1.4f, 0.3f}, {0.5f, 2.2f}, {any, any}},
     true},
    {"Rectangle", {V3f(0, 0, 0), {3, 0, 0}, {3, 2, 0}, {0, 2, 0}}, {V2f(0, 0), {3, 0}, {3, 2}, {0, 2}}},
    {"Parallelogram",
     {V3f(0, 0, 0), {3, 1, 0}, {4, 3, 0}, {1, 2, 0}},
     {V2f(0.3f, 0), {0.9f, 0.7f}, {0.5f, 1.5f}, {-0.1f, 0.8f}}},
    {"Trapezoid", {V3f(0, 0, 0), {4, 0, 0}, {3, 2, 0}, {1, 2, 0}}, {V2f(0, 0), {1.6f, 0}, {1.2f, 0.8f}, {0.4f, 0.8f}}},
    // Not linear in space: means of cells are approximate.
    {"ImageOnTrapezoid",
     {V3f(0, 0, 0), {4, 0, 0}, {3, 2, 0}, {1, 2, 0}},
     {V2f(0, 0), {1, 0}, {1, 1}, {0, 1}},
     false,
     5e-3f},
};

class TextureMeansOf : public testing::TestWithParam<Shape> {
  protected:
    TextureMeansOf() {
        const Shape& shape = GetParam();
        testing_support::add_material(scene, Rgb(0.5f), Rgb(0));
        scene.objects = {""};
        scene.vertices.assign(shape.corners.begin(), shape.corners.end());
        scene.texture_coordinates.assign(shape.coordinates.begin(), shape.coordinates.end());
        scene.patches = {{.vertices = {0, 1, 2, shape.is_triangle ? none : 3}}};
        Texture texture{"random", 16, 16, {}};
        for (std::uint64_t i = 0; i < 256; ++i)
            texture.texels.emplace_back(static_cast<float>(mix(i, 1) % 1'000) / 1'000);
        scene.textures = {texture};
    }
    Scene scene;
};
INSTANTIATE_TEST_SUITE_P(Shapes, TextureMeansOf, testing::ValuesIn(shapes), testing::PrintToStringParamName());

TEST_P(TextureMeansOf, CellsAreThoseOfTheirChildren) {
    const TextureMeans means(scene);
    ElementForest forest(scene, 10'000);
    for (ElementIndex e{0}; e < 85; ++e) forest.subdivide(e);  // three levels
    for (ElementIndex e{0}; e < 85; ++e) {
        const auto mean = [&](std::uint32_t i) {
            return means.mean(0, scene.patches[0], forest.geometry(PatchIndex(0)), forest.cell(ElementIndex(i))).x;
        };
        float sum = 0;
        for (std::uint32_t k = 0; k < 4; ++k)
            sum += mean(forest.first_child(e) + k) * forest.area(forest.first_child(e) + k);
        EXPECT_NEAR(mean(e), sum / forest.area(e), GetParam().tolerance) << "element " << e;
    }
}

TEST_P(TextureMeansOf, CellsAreThoseOfTheirPoints) {
    constexpr int n = 300;
    const PatchGeometry geometry(scene, scene.patches[0]);
    double sum = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Parameters p =
                geometry.uniform_parameters((static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n);
            sum += static_cast<double>(texel_at(scene.textures[0], texture_coordinate(scene, scene.patches[0], p)).x);
        }
    EXPECT_NEAR(TextureMeans(scene).mean(0, scene.patches[0], geometry, Cell()).x, sum / (n * n), 3e-3);
}

TEST_P(TextureMeansOf, NoTextureAreOne) {
    EXPECT_EQ(TextureMeans(scene).mean(none, scene.patches[0], PatchGeometry(scene, scene.patches[0]), Cell()), Rgb(1));
}

}  // namespace
}  // namespace interflect
