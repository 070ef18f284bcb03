// Texture and lightmap coordinates through all operations that create vertices: coordinates that are linear in space
// stay so.
//
// Seen to fail when cuts or crossings of outlines make vertices without coordinates, splits with those of a corner,
// when either kind is interpolated as the other, when vertices that differ in coordinates alone are merged, and when a
// seam between images divides a flat surface.
#include "interflect/geometry/textures/texture_mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "interflect/geometry/polygons/polygon.h"
#include "interflect/geometry/search/vertex_weld.h"
#include "interflect/geometry/surfaces/flat_surfaces.h"
#include "interflect/prepare.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// An image laid askew on the plane z = 0.
V2f laid(const V3f& x) { return {0.3f * x.x - 0.1f * x.y + 0.7f, 0.2f * x.x + 0.4f * x.y - 0.3f}; }

/// A chart of a lightmap with another orientation.
V2f charted(const V3f& x) { return {0.12f * x.x + 0.02f * x.y + 0.05f, 0.8f - 0.15f * x.y - 0.01f * x.x}; }

const V2f no_chart(std::numeric_limits<float>::quiet_NaN());

void lay_image(Scene& scene) {
    for (const V3f& x : scene.vertices) {
        scene.texture_coordinates.push_back(laid(x));
        scene.lightmap_coordinates.push_back(charted(x));
    }
}

/// A trapezoid and a triangle in the plane z = 0, with image and chart; walls without a chart stand on them.
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
    for (std::size_t i = 5; i < scene.vertices.size(); ++i) scene.lightmap_coordinates[i] = no_chart;
    return scene;
}

void expect_near(const V2f& actual, const V2f& expected) {
    EXPECT_NEAR(actual.x, expected.x, 1e-5f);
    EXPECT_NEAR(actual.y, expected.y, 1e-5f);
}

/// Expects unchanged image and chart coordinates at the corners and in the middle of each patch of material 0, and no
/// chart elsewhere.
void expect_laid(const Scene& scene) {
    ASSERT_THAT(scene_faults(scene), testing::IsEmpty());
    ASSERT_EQ(scene.texture_coordinates.size(), scene.vertices.size());
    ASSERT_EQ(scene.lightmap_coordinates.size(), scene.vertices.size());
    for (const Patch& patch : scene.patches) {
        const PatchGeometry geometry(scene, patch);
        for (const Parameters p : {Parameters{0, 0}, {1, 0}, {0, 1}, {0.3f, 0.4f}}) {
            const VertexCoordinates actual = coordinates_at(scene, patch, p);
            ASSERT_EQ(actual.lightmap.has_value(), patch.material == 0);
            if (patch.material != 0) continue;
            expect_near(texture_coordinate(scene, patch, p), laid(geometry.point(p)));
            expect_near(actual.texture.value(), laid(geometry.point(p)));
            expect_near(*actual.lightmap, charted(geometry.point(p)));
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
    EXPECT_EQ(weld.vertex({1, 2, 3}, {.texture = V2f(0.5f, 0), .lightmap = {}}), 1u);
    EXPECT_EQ(weld.vertex({1, 2, 3}, {.texture = V2f(0.5f, 1), .lightmap = {}}), 2u);
    EXPECT_EQ(weld.vertex({1, 2, 3}, {.texture = V2f(0.5f, 0), .lightmap = {}}), 1u);
    EXPECT_EQ(weld.vertex({1, 2, 3}), 0u);
    EXPECT_EQ(scene.texture_coordinates, (std::vector<V2f>{{0, 0}, {0.5f, 0}, {0.5f, 1}}));
    EXPECT_TRUE(scene.lightmap_coordinates.empty());
}

TEST(VertexWeld, KeepsVerticesApartThatDifferInLightmapsAlone) {
    Scene scene;
    VertexWeld weld(scene);
    EXPECT_EQ(weld.vertex({1, 2, 3}), 0u);
    EXPECT_EQ(weld.vertex({1, 2, 3}, {.texture = {}, .lightmap = V2f(0)}), 1u) << "a place, other than none";
    EXPECT_EQ(weld.vertex({1, 2, 3}, {.texture = {}, .lightmap = V2f(-0.0f, 0)}), 1u);
    for (const bool are_new : {true, false}) {
        for (std::uint32_t i = 2; i < 1000; ++i) {
            const V2f coordinate(static_cast<float>(i) / 1000, 0.5f);
            ASSERT_EQ(weld.vertex({1, 2, 3}, {.texture = {}, .lightmap = coordinate}), i) << are_new;
        }
    }
    EXPECT_EQ(weld.vertex({1, 2, 3}), 0u);
    ASSERT_EQ(scene.lightmap_coordinates.size(), scene.vertices.size());
    EXPECT_TRUE(std::isnan(scene.lightmap_coordinates[0].x) && std::isnan(scene.lightmap_coordinates[0].y));
}

TEST(VertexWeld, LeavesASceneWithoutCoordinatesWithout) {
    Scene scene;
    VertexWeld weld(scene);
    weld.vertex({1, 2, 3});
    EXPECT_TRUE(scene.texture_coordinates.empty());
    EXPECT_TRUE(scene.lightmap_coordinates.empty());
}

TEST(VertexCoordinates, StayInTheLightmapWhateverRoundingDoes) {
    Scene scene;
    for (const float u : {0.0f, 1.0f}) add_vertex(scene, {u, 0, 0}, {.texture = {}, .lightmap = V2f(u, 1 - u)});
    const std::vector<std::uint32_t> vertices = {0, 1};
    const std::vector<float> weights = {-1e-6f, 1.000001f};
    EXPECT_EQ(interpolated(scene, vertices, weights).lightmap, V2f(1, 0));
}

struct Coordinates {
    const char* name;
    std::vector<V2f> Scene::*member;
};
void PrintTo(const Coordinates& coordinates, std::ostream* out) { *out << coordinates.name; }

/// Two squares side by side, each with the whole image or lightmap and so with separate vertices.
class SeamInAFlatSurface : public testing::TestWithParam<Coordinates> {};

TEST_P(SeamInAFlatSurface, DoesNotDivideIt) {
    Scene scene;
    add_material(scene, Rgb(0.5f), Rgb(0));
    scene.objects = {""};
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
    scene.*GetParam().member = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.patches = {{.vertices = {0, 1, 2, 3}}, {.vertices = {4, 5, 6, 7}}};
    const std::vector<std::uint32_t> surface = flat_surfaces(scene);
    EXPECT_EQ(surface[0], surface[1]);
}

INSTANTIATE_TEST_SUITE_P(Of, SeamInAFlatSurface,
                         testing::Values(Coordinates{"Textures", &Scene::texture_coordinates},
                                         Coordinates{"Lightmaps", &Scene::lightmap_coordinates}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace interflect
