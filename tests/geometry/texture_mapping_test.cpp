// Texture coordinates through all that makes new vertices: a coordinate that is linear in space stays so.
//
// Seen to fail when cuts or crossings of outlines make vertices without coordinates, splits with those of a corner,
// when vertices that differ in coordinates alone are merged, and when a seam between images divides a flat surface.
#include "interflect/geometry/texture_mapping.h"

#include <gtest/gtest.h>

#include "interflect/contacts.h"
#include "interflect/geometry/flat_surfaces.h"
#include "interflect/geometry/polygon.h"
#include "interflect/geometry/split.h"
#include "interflect/geometry/vertex_weld.h"
#include "tests/support/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

/// An image laid askew on the plane z = 0.
V2f laid(const V3f& x) { return {0.3f * x.x - 0.1f * x.y + 0.7f, 0.2f * x.x + 0.4f * x.y - 0.3f}; }

void lay_image(Scene& scene) {
    scene.texture_coordinates.clear();
    for (const V3f& x : scene.vertices) scene.texture_coordinates.push_back(laid(x));
}

/// A trapezoid and a triangle in the plane z = 0, with the image, and walls that stand on them.
Scene floor_with_walls() {
    Scene scene;
    add_material(scene, Rgb(0.5f), Rgb(0));
    add_material(scene, Rgb(0.2f), Rgb(0));
    scene.textures = {{"image", 1, 1, {Rgb(1)}}};
    scene.materials[0].reflectance_texture = 0;
    scene.objects = {""};
    scene.vertices = {{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {0.5f, 2, 0}, {4, 2, 0}};
    scene.patches = {{.vertices = {0, 1, 2, 3}}, {.vertices = {1, 4, 2, none}}};
    add_rectangle(scene, {1, -1, 0}, {0.3f, 4, 0}, {0, 0, 1}, 1, 1, 1, true);
    add_rectangle(scene, {-1, 0.4f, 0}, {7, 0.5f, 0}, {0, 0, 1}, 1, 1, 1, true);
    lay_image(scene);
    return scene;
}

/// Whether the image is where it was, at the corners and in the middle of each patch of material 0.
void expect_laid(const Scene& scene) {
    ASSERT_EQ(scene_faults(scene), std::vector<std::string>());
    ASSERT_EQ(scene.texture_coordinates.size(), scene.vertices.size());
    for (const Patch& patch : scene.patches) {
        if (patch.material != 0) continue;
        const PatchGeometry geometry(scene, patch);
        for (const Parameters p : {Parameters{0, 0}, {1, 0}, {0, 1}, {0.3f, 0.4f}}) {
            const V2f expected = laid(geometry.point(p)), actual = texture_coordinate(scene, patch, p);
            EXPECT_NEAR(actual.x, expected.x, 1e-5f);
            EXPECT_NEAR(actual.y, expected.y, 1e-5f);
        }
    }
}

TEST(TextureMapping, IsKeptByCutsAtContacts) {
    const Scene scene = floor_with_walls(), cut = cut_at_contacts(scene);
    ASSERT_GT(cut.patches.size(), scene.patches.size() + 4);
    expect_laid(cut);
}

TEST(TextureMapping, IsKeptBySplitting) {
    const Scene split = split_patches(floor_with_walls(), 0.5f, 10'000);
    ASSERT_GT(split.patches.size(), 50u);
    expect_laid(split);
}

TEST(TextureMapping, IsInterpolatedWhereOutlinesCross) {
    Scene scene;
    add_material(scene, Rgb(0.5f), Rgb(0));
    scene.objects = {""};
    scene.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, -1, 0}, {6, -1, 0}, {6, 2, 0}, {2, 2, 0}};
    lay_image(scene);
    const std::vector<std::vector<std::uint32_t>> loops = {{0, 1, 2, 3}, {4, 5, 6, 7}};
    ASSERT_EQ(add_polygon(scene, loops, 0, 0, false), PolygonResult::added);
    ASSERT_GT(scene.vertices.size(), 8u) << "where the outlines cross";
    expect_laid(scene);
}

TEST(TextureMapping, TexelMultipliesWhatTheMaterialDoes) {
    Scene scene;
    scene.materials = {{.name = "m", .reflectance = Rgb(0.8f), .exitance = Rgb(10), .reflectance_texture = 0}};
    scene.textures = {{"two", 2, 1, {Rgb(0.5f), Rgb(1)}}};
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    for (const V3f& x : scene.vertices) scene.texture_coordinates.emplace_back(x.x, x.y);
    const Patch& patch = scene.patches[0];
    EXPECT_NEAR(reflectance_at(scene, patch, {0.25f, 0.5f}).x, 0.4f, 1e-6f);
    EXPECT_NEAR(reflectance_at(scene, patch, {0.75f, 0.1f}).x, 0.8f, 1e-6f);
    EXPECT_EQ(exitance_at(scene, patch, {0.25f, 0.5f}), Rgb(10)) << "has no texture";
}

TEST(VertexWeld, KeepsVerticesApartThatDifferInCoordinates) {
    Scene scene;
    VertexWeld weld(scene);
    EXPECT_EQ(weld.vertex({1, 2, 3}), 0u);
    EXPECT_EQ(weld.vertex({1, 2, 3}, V2f(0.5f, 0)), 1u);
    EXPECT_EQ(weld.vertex({1, 2, 3}, V2f(0.5f, 1)), 2u);
    EXPECT_EQ(weld.vertex({1, 2, 3}, V2f(0.5f, 0)), 1u);
    EXPECT_EQ(weld.vertex({1, 2, 3}), 0u);
    EXPECT_EQ(scene.texture_coordinates, (std::vector<V2f>{{0, 0}, {0.5f, 0}, {0.5f, 1}}));
}

TEST(VertexWeld, LeavesASceneWithoutCoordinatesWithout) {
    Scene scene;
    VertexWeld weld(scene);
    weld.vertex({1, 2, 3});
    EXPECT_TRUE(scene.texture_coordinates.empty());
}

TEST(FlatSurfaces, AreNotDividedWhereImagesMeet) {
    Scene scene;
    add_material(scene, Rgb(0.5f), Rgb(0));
    scene.objects = {""};
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
    scene.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.patches = {{.vertices = {0, 1, 2, 3}}, {.vertices = {4, 5, 6, 7}}};
    const std::vector<std::uint32_t> surface = flat_surfaces(scene);
    EXPECT_EQ(surface[0], surface[1]);
}

}  // namespace
}  // namespace interflect
