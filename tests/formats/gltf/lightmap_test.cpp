// The lightmap coordinates of a glTF file: its second set of texture coordinates.
//
// Seen to fail when v is not flipped, when normalised integers are not divided, when coordinates outside a lightmap are
// kept, when a texture's transform is applied to them, and when instances share a part of a lightmap.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/formats/gltf/builder.h"
#include "tests/support/parameter_names.h"

namespace interflect {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using namespace testing_support;

const std::vector<V2f> layout = {{0.25f, 0.125f}, {1, 0}, {0, 1}};  // of the triangle's vertices, v downwards

json& attributes(GltfBuilder& file, std::size_t mesh = 0) {
    return file.file["meshes"][mesh]["primitives"][0]["attributes"];
}

GltfBuilder triangle_with_layout(const std::vector<V2f>& coordinates = layout) {
    GltfBuilder file;
    file.add_triangle({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}});
    attributes(file)["TEXCOORD_1"] = file.add_coordinates(coordinates);
    return file;
}

std::vector<V2f> lightmap_coordinates(const Scene& scene, std::size_t patch) {
    std::vector<V2f> result;
    for (std::size_t k = 0; k < 3; ++k)
        result.push_back(scene.lightmap_coordinates.at(scene.patches.at(patch).vertices[k]));
    return result;
}

bool has_layout(const Scene& scene, std::size_t patch) { return !std::isnan(lightmap_coordinates(scene, patch)[0].x); }

TEST(GltfLightmap, CoordinatesAreKeptWithVGoingUp) {
    const Scene scene = triangle_with_layout().read();
    EXPECT_THAT(lightmap_coordinates(scene, 0), ElementsAre(V2f(0.25f, 0.875f), V2f(1, 1), V2f(0, 0)));
    EXPECT_THAT(lightmap_coordinates(scene, 1), ElementsAre(V2f(0.25f, 0.875f), V2f(0, 0), V2f(1, 1))) << "the back";
    EXPECT_THAT(scene.texture_coordinates, IsEmpty()) << "there is no texture";
    EXPECT_THAT(warning_kinds(scene), IsEmpty());
}

TEST(GltfLightmap, FilesWithoutHaveNone) {
    GltfBuilder file;
    file.add_triangle();
    EXPECT_THAT(file.read().lightmap_coordinates, IsEmpty()) << "TEXCOORD_0 is the textures'";
}

TEST(GltfLightmap, NormalisedIntegersAreFractions) {
    GltfBuilder file = triangle_with_layout();
    const std::vector<std::uint16_t> values = {0, 65535, 13107, 39321, 65535, 0};
    const int accessor = file.add_accessor(file.add_view(bytes_of_values(values)), GltfBuilder::ushort_type, 3, "VEC2");
    file.file["accessors"][static_cast<std::size_t>(accessor)]["normalized"] = true;
    attributes(file)["TEXCOORD_1"] = accessor;
    EXPECT_THAT(lightmap_coordinates(file.read(), 0), ElementsAre(V2f(0, 0), V2f(0.2f, 0.4f), V2f(1, 1)));
}

TEST(GltfLightmap, RoundingBeyondItsBordersIsClamped) {
    const Scene scene = triangle_with_layout({{-0.00005f, 0}, {1.00005f, 1.00005f}, {0.5f, -0.00005f}}).read();
    EXPECT_THAT(lightmap_coordinates(scene, 0), ElementsAre(V2f(0, 1), V2f(1, 0), V2f(0.5f, 1)));
}

class NoPlaceInALightmap : public testing::TestWithParam<V2f> {};

TEST_P(NoPlaceInALightmap, IsIgnoredWithAWarning) {
    std::vector<V2f> coordinates = layout;
    coordinates[2] = GetParam();
    const Scene scene = triangle_with_layout(coordinates).read();
    EXPECT_THAT(scene.lightmap_coordinates, IsEmpty());
    ASSERT_THAT(warning_kinds(scene), ElementsAre("lightmap-coordinates"));
    EXPECT_THAT(scene.warnings.entries()[0].where, HasSubstr("meshes[0].primitives[0]"));
}

constexpr float infinity = std::numeric_limits<float>::infinity();
INSTANTIATE_TEST_SUITE_P(At, NoPlaceInALightmap,
                         testing::Values(V2f(1.001f, 0), V2f(0, -0.001f), V2f(3, 3), V2f(0, infinity),
                                         V2f(infinity - infinity, 0)),
                         printed_name);

TEST(GltfLightmap, OneForEveryVertexIsNeeded) {
    EXPECT_THAT(triangle_with_layout({{0, 0}, {1, 1}}).fault(), HasSubstr("2 texture coordinates for 3 vertices"));
}

/// Two triangles in one object: the primitives of one mesh.
GltfBuilder two_primitives() {
    GltfBuilder file = triangle_with_layout();
    json other = file.file["meshes"][0]["primitives"][0];
    other["attributes"]["POSITION"] = file.add_vectors({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    file.file["meshes"][0]["primitives"].push_back(other);
    return file;
}

TEST(GltfLightmap, PrimitivesOfAMeshShareIt) {
    const Scene scene = two_primitives().read();
    EXPECT_TRUE(has_layout(scene, 0));
    EXPECT_TRUE(has_layout(scene, 2));
}

TEST(GltfLightmap, PrimitivesWithoutCoordinatesHaveNone) {
    GltfBuilder file = two_primitives();
    file.file["meshes"][0]["primitives"][1]["attributes"].erase("TEXCOORD_1");
    const Scene scene = file.read();
    EXPECT_TRUE(has_layout(scene, 0));
    EXPECT_FALSE(has_layout(scene, 2));
}

TEST(GltfLightmap, NodesThatShowAMeshHaveOneEach) {
    GltfBuilder file = triangle_with_layout();
    file.file["nodes"][0]["name"] = "left";
    file.add_node({{"mesh", 0}, {"name", "right"}, {"translation", {2, 0, 0}}});
    const Scene scene = file.read();
    EXPECT_TRUE(has_layout(scene, 0));
    EXPECT_TRUE(has_layout(scene, 2));
    EXPECT_NE(scene.patches[0].object, scene.patches[2].object);
}

TEST(GltfLightmap, OfInstancesInOneObjectIsIgnoredWithAWarning) {
    GltfBuilder file = triangle_with_layout();
    file.file["nodes"][0]["name"] = "chairs";
    file.file["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        file.add_vectors({{0, 0, 0}, {5, 0, 0}, {9, 0, 0}});
    file.add_node({{"mesh", 0}, {"name", "table"}, {"translation", {2, 0, 0}}});
    const Scene scene = file.read();
    ASSERT_EQ(scene.patches.size(), 8u);
    EXPECT_FALSE(has_layout(scene, 0));
    EXPECT_FALSE(has_layout(scene, 4));
    EXPECT_TRUE(has_layout(scene, 6)) << "the table's";
    ASSERT_THAT(warning_kinds(scene), ElementsAre("lightmap-coordinates"));
    EXPECT_EQ(scene.warnings.entries()[0].where, "test.glb: object 'chairs'");
    EXPECT_EQ(scene.warnings.entries()[0].count, 1);
}

}  // namespace
}  // namespace interflect
