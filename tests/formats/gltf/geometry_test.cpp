// Positions of faces in glTF: nodes, instances, primitive modes, accessors of every kind and compressed meshes.
//
// Seen to fail when matrices are transposed, when strips do not turn, when normalised integers are not divided, when
// sparse elements are not replaced and when the filter of a compressed view is not applied.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <numbers>

#include "tests/formats/gltf/builder.h"

namespace interflect {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using namespace testing_support;

constexpr float tolerance = 1e-6f;

void expect_corners(const Scene& scene, std::size_t patch, const std::vector<V3f>& expected) {
    const std::vector<V3f> found = corners(scene, patch);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT((found[i] - expected[i]).length(), tolerance) << i << ": " << found[i] << ", not " << expected[i];
}

TEST(GltfNodes, TransformIsScaledThenTurnedThenMoved) {
    GltfBuilder file;
    json& node = file.add_triangle();
    const double half = std::numbers::sqrt2 / 2;  // a quarter turn about z: x goes to y
    node.update({{"scale", {2, 3, 1}}, {"rotation", {0, 0, half, half}}, {"translation", {10, 0, 0}}});
    expect_corners(file.read(), 0, {{10, 0, 0}, {10, 2, 0}, {7, 0, 0}});
}

TEST(GltfNodes, MatricesAreColumnByColumn) {
    GltfBuilder file;
    file.add_triangle()["matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1};
    expect_corners(file.read(), 0, {{10, 0, 0}, {10, 2, 0}, {7, 0, 0}});
}

TEST(GltfNodes, ChildrenMoveWithTheirParents) {
    GltfBuilder file;
    file.add_triangle()["name"] = "leg";
    file.file["nodes"][0]["translation"] = {1, 0, 0};
    file.file["nodes"].push_back({{"name", "desk"}, {"scale", {2, 2, 2}}, {"children", {0}}});
    file.file["nodes"].push_back({{"name", "room"}, {"translation", {0, 0, 5}}, {"children", {1}}});
    file.file["scenes"][0]["nodes"] = {2};
    const Scene scene = file.read();
    expect_corners(scene, 0, {{2, 0, 5}, {4, 0, 5}, {2, 2, 5}});
    EXPECT_EQ(scene.objects[scene.patches[0].object], "room.desk.leg");
}

TEST(GltfNodes, OutsideTheSceneAreNotShown) {
    GltfBuilder file;
    file.add_triangle();
    file.file["nodes"].push_back(file.file["nodes"][0]);
    EXPECT_EQ(file.read().patches.size(), 2u);
    file.file.erase("scenes");
    file.file.erase("scene");
    EXPECT_EQ(file.read().patches.size(), 4u) << "without a scene, all roots are shown";
}

TEST(GltfNodes, AHundredThousandLevelsAreRead) {
    GltfBuilder file;
    file.add_triangle();
    constexpr int depth = 100'000;
    for (int i = 1; i < depth; ++i) file.file["nodes"].push_back({{"children", {i - 1}}});
    file.file["scenes"][0]["nodes"] = {depth - 1};
    EXPECT_EQ(file.read().patches.size(), 2u);
}

TEST(GltfNodes, InstancesArePlacedBeforeTheirNode) {
    GltfBuilder file;
    json& node = file.add_triangle();
    node["translation"] = {0, 0, 1};
    const int moves = file.add_vectors({{0, 0, 0}, {5, 0, 0}}), scales = file.add_vectors({{1, 1, 1}, {2, 2, 2}});
    file.file["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", moves},
                                                                                    {"SCALE", scales}};
    const Scene scene = file.read();
    ASSERT_EQ(scene.patches.size(), 4u);
    expect_corners(scene, 2, {{5, 0, 1}, {7, 0, 1}, {5, 2, 1}});
}

struct ModeCase {
    const char* name;
    int mode;
    std::vector<std::vector<V3f>> triangles;
};
void PrintTo(const ModeCase& mode, std::ostream* out) { *out << mode.name; }

class GltfModes : public testing::TestWithParam<ModeCase> {};

/// Five points that are not coplanar, so that no two triangles become a quadrilateral.
const std::vector<V3f> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5f}, {0, 2, 1}};

TEST_P(GltfModes, GiveTheirTriangles) {
    for (const bool indexed : {false, true}) {
        GltfBuilder file;
        json primitive = {{"attributes", {{"POSITION", file.add_vectors(points)}}}, {"mode", GetParam().mode}};
        if (indexed) primitive["indices"] = file.add_indices({0, 1, 2, 3, 4});
        if (GetParam().mode == 4) primitive["indices"] = file.add_indices({0, 1, 2});
        file.add_node({{"mesh", file.add_mesh(primitive)}});
        const Scene scene = file.read();
        ASSERT_EQ(scene.patches.size(), 2 * GetParam().triangles.size());
        for (std::size_t i = 0; i < GetParam().triangles.size(); ++i)
            expect_corners(scene, 2 * i, GetParam().triangles[i]);
    }
}

INSTANTIATE_TEST_SUITE_P(All, GltfModes,
                         testing::Values(ModeCase{"Triangles", 4, {{points[0], points[1], points[2]}}},
                                         ModeCase{"Strip",
                                                  5,
                                                  {{points[0], points[1], points[2]},
                                                   {points[1], points[3], points[2]},
                                                   {points[2], points[3], points[4]}}},
                                         ModeCase{"Fan",
                                                  6,
                                                  {{points[0], points[1], points[2]},
                                                   {points[0], points[2], points[3]},
                                                   {points[0], points[3], points[4]}}}),
                         testing::PrintToStringParamName());

TEST(GltfModes, PointsAndLinesAreLeftOut) {
    GltfBuilder file;
    file.add_triangle();
    for (int mode = 0; mode < 4; ++mode) {
        json primitive = file.file["meshes"][0]["primitives"][0];
        primitive["mode"] = mode;
        file.file["meshes"][0]["primitives"].push_back(primitive);
    }
    const Scene scene = file.read();
    EXPECT_EQ(scene.patches.size(), 2u);
    EXPECT_THAT(warning_kinds(scene), testing::Contains("no-faces"));
}

/// Returns the triangle's positions as integers of some type. @param one  The representation of 1.
template <class T>
std::string integer_positions(T one) {
    return bytes_of_values(std::vector<T>{0, 0, 0, 0, one, 0, 0, 0, 0, one, 0, 0});  // three, and one of padding
}

struct IntegerCase {
    const char* name;
    int component_type;
    bool normalized;
    std::string bytes;
};
void PrintTo(const IntegerCase& type, std::ostream* out) { *out << type.name; }

class GltfIntegers : public testing::TestWithParam<IntegerCase> {};

TEST_P(GltfIntegers, AreQuantisedPositions) {
    GltfBuilder file;
    file.add_triangle();
    const int view = file.add_view(GetParam().bytes);
    file.file["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = GetParam().bytes.size() / 3;
    json& accessor = file.file["accessors"][0];
    accessor.update(
        {{"bufferView", view}, {"componentType", GetParam().component_type}, {"normalized", GetParam().normalized}});
    expect_corners(file.read(), 0, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfIntegers,
    testing::Values(IntegerCase{"Byte", 5120, false, integer_positions<std::int8_t>(1)},
                    IntegerCase{"UnsignedByte", 5121, false, integer_positions<std::uint8_t>(1)},
                    IntegerCase{"Short", 5122, false, integer_positions<std::int16_t>(1)},
                    IntegerCase{"UnsignedShort", 5123, false, integer_positions<std::uint16_t>(1)},
                    IntegerCase{"ByteOfOne", 5120, true, integer_positions<std::int8_t>(127)},
                    IntegerCase{"UnsignedByteOfOne", 5121, true, integer_positions<std::uint8_t>(255)},
                    IntegerCase{"ShortOfOne", 5122, true, integer_positions<std::int16_t>(32767)},
                    IntegerCase{"UnsignedShortOfOne", 5123, true, integer_positions<std::uint16_t>(65535)}),
    testing::PrintToStringParamName());

TEST(GltfAccessors, InterleavedElementsAreAStrideApart) {
    GltfBuilder file;
    file.add_triangle();
    const int view = file.add_view(
        bytes_of_values(std::vector<V3f>{{9, 9, 9}, {0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {9, 9, 9}, {0, 4, 0}}));
    file.file["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 24;
    file.file["accessors"][0].update({{"bufferView", view}, {"byteOffset", 12}});
    expect_corners(file.read(), 0, {{0, 0, 0}, {1, 0, 0}, {0, 4, 0}});
}

TEST(GltfAccessors, SparseElementsReplaceThoseBelow) {
    for (const bool has_base : {true, false}) {
        GltfBuilder file;
        file.add_triangle();
        const int places = file.add_view(bytes_of_values(std::vector<std::uint16_t>{1, 2}));
        const int values = file.add_view(bytes_of_values(std::vector<V3f>{{3, 0, 0}, {0, 0, 5}}));
        json& accessor = file.file["accessors"][0];
        accessor["sparse"] = {{"count", 2},
                              {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                              {"values", {{"bufferView", values}}}};
        if (!has_base) accessor.erase("bufferView");
        expect_corners(file.read(), 0, {{0, 0, 0}, {3, 0, 0}, {0, 0, 5}});
    }
}

TEST(GltfMeshes, MorphTargetsHaveTheirDefaultWeights) {
    GltfBuilder file;
    json& node = file.add_triangle();
    const int mesh = node["mesh"];
    const int target = file.add_vectors({{0, 0, 0}, {2, 0, 0}, {0, 0, 4}});
    file.file["meshes"][static_cast<std::size_t>(mesh)]["primitives"][0]["targets"] = {{{"POSITION", target}}};
    expect_corners(file.read(), 0, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    file.file["meshes"][static_cast<std::size_t>(mesh)]["weights"] = {0.5};
    expect_corners(file.read(), 0, {{0, 0, 0}, {2, 0, 0}, {0, 1, 2}});
    file.file["nodes"][0]["weights"] = {1};
    expect_corners(file.read(), 0, {{0, 0, 0}, {3, 0, 0}, {0, 1, 4}});
}

TEST(GltfMeshes, SkinsAreInTheirPose) {
    GltfBuilder file;
    json& node = file.add_triangle();
    node["translation"] = {100, 0, 0};  // ignored: joints place the mesh
    node["skin"] = 0;
    json& attributes = file.file["meshes"][0]["primitives"][0]["attributes"];
    const auto joints = std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    const auto weights = std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0};
    attributes["JOINTS_0"] = file.add_accessor(file.add_view(bytes_of_values(joints)), 5121, 3, "VEC4");
    attributes["WEIGHTS_0"] =
        file.add_accessor(file.add_view(bytes_of_values(weights)), GltfBuilder::float_type, 3, "VEC4");
    const auto bind = std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,   //
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};  // 1 m back along x
    const int inverse = file.add_accessor(file.add_view(bytes_of_values(bind)), GltfBuilder::float_type, 2, "MAT4");
    const int still = file.add_node({{"name", "hip"}}), moved = file.add_node({{"translation", {1, 0, 6}}});
    file.file["skins"] = {{{"joints", {still, moved}}, {"inverseBindMatrices", inverse}}};
    expect_corners(file.read(), 0, {{0, 0, 0}, {1, 0, 6}, {0, 1, 3}});
}

// ---- Compressed meshes

/// Rotates the vertices: compressors may begin a triangle with another of its corners.
std::vector<V3f> from_origin(std::vector<V3f> found) {
    std::rotate(found.begin(), std::find(found.begin(), found.end(), V3f(0)), found.end());
    return found;
}

/// @param mode, filter  As in the extension.
void compress_view(GltfBuilder& file, int view, const std::string& compressed, std::size_t count, std::size_t stride,
                   const char* mode, const char* filter = "NONE") {
    const int packed = file.add_view(compressed);
    json extension = file.file["bufferViews"][static_cast<std::size_t>(packed)];
    extension.update({{"count", count}, {"byteStride", stride}, {"mode", mode}, {"filter", filter}});
    file.file["bufferViews"][static_cast<std::size_t>(view)]["extensions"]["EXT_meshopt_compression"] = extension;
    file.file["extensionsRequired"] = {"EXT_meshopt_compression"};
}

template <class T>
std::string encode_vertices(const std::vector<T>& values) {
    std::string result(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)), '\0');
    result.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(result.data()), result.size(),
                                             values.data(), values.size(), sizeof(T)));
    return result;
}

TEST(GltfMeshopt, VerticesAndIndicesAreDecoded) {
    for (const bool as_triangles : {true, false}) {
        GltfBuilder file;
        file.add_triangle();
        file.file["meshes"][0]["primitives"][0]["indices"] = file.add_indices({0, 0, 0});
        const auto view = [&](int accessor) -> int {
            return file.file["accessors"][static_cast<std::size_t>(accessor)]["bufferView"];
        };
        compress_view(file, view(0), encode_vertices(std::vector<V3f>{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}), 3, 12,
                      "ATTRIBUTES");
        const std::vector<unsigned> indices = {1, 2, 0};
        std::string packed(meshopt_encodeIndexBufferBound(3, 3) + meshopt_encodeIndexSequenceBound(3, 3), '\0');
        auto* data = reinterpret_cast<unsigned char*>(packed.data());
        packed.resize(as_triangles ? meshopt_encodeIndexBuffer(data, packed.size(), indices.data(), 3)
                                   : meshopt_encodeIndexSequence(data, packed.size(), indices.data(), 3));
        compress_view(file, view(2), packed, 3, 2, as_triangles ? "TRIANGLES" : "INDICES");
        EXPECT_THAT(from_origin(corners(file.read(), 0)), ElementsAre(V3f(0), V3f(2, 0, 0), V3f(0, 3, 0)));
    }
}

TEST(GltfMeshopt, ExponentialFilterIsUndone) {
    GltfBuilder file;
    file.add_triangle();
    const std::vector<V3f> positions = {{0, 0, 0}, {1.5f, 0, 0}, {0, 1.25f, 0}};
    std::vector<V3f> filtered(3);
    meshopt_encodeFilterExp(filtered.data(), 3, 12, 15, &positions[0].x);
    compress_view(file, 0, encode_vertices(filtered), 3, 12, "ATTRIBUTES", "EXPONENTIAL");
    expect_corners(file.read(), 0, positions);
}

TEST(GltfMeshopt, QuaternionFilterIsUndone) {
    GltfBuilder file;
    file.add_triangle();
    const float half = std::numbers::sqrt2_v<float> / 2;  // a quarter turn about z
    const std::vector<float> turn = {0, 0, half, half};
    std::vector<std::array<std::int16_t, 4>> filtered(1);
    meshopt_encodeFilterQuat(filtered.data(), 1, 8, 16, turn.data());
    const int view = file.add_view(std::string(8, '\0'));
    compress_view(file, view, encode_vertices(filtered), 1, 8, "ATTRIBUTES", "QUATERNION");
    const int turns = file.add_accessor(view, 5122, 1, "VEC4");
    file.file["accessors"][static_cast<std::size_t>(turns)]["normalized"] = true;
    file.file["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"ROTATION", turns}};
    const std::vector<V3f> found = corners(file.read(), 0), expected = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((found[i] - expected[i]).length(), 1e-3f) << "16 bits";
}

/// Compresses a triangle with positions and two sets of texture coordinates.
std::string draco_triangle() {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(1);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int coordinate = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const int lightmap = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const float positions[3][3] = {{0, 0, 0}, {4, 0, 0}, {0, 2, 0}}, coordinates[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), positions[0], positions[1], positions[2]);
    builder.SetAttributeValuesForFace(coordinate, draco::FaceIndex(0), coordinates[0], coordinates[1], coordinates[2]);
    const float layout[3][2] = {{0, 0}, {0.5f, 0}, {0, 0.25f}};
    builder.SetAttributeValuesForFace(lightmap, draco::FaceIndex(0), layout[0], layout[1], layout[2]);
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.size()};
}

GltfBuilder draco_file() {
    GltfBuilder file;
    file.add_triangle();
    json& primitive = file.file["meshes"][0]["primitives"][0];
    primitive["indices"] = file.add("accessors", {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
    file.file["accessors"][0].erase("bufferView");
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.add_view(draco_triangle())},
        {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}, {"TEXCOORD_1", 2}}}};
    return file;
}

TEST(GltfDraco, MeshesAreDecoded) {
    const Scene scene = draco_file().read();
    ASSERT_EQ(scene.patches.size(), 2u);
    EXPECT_THAT(from_origin(corners(scene, 0)), ElementsAre(V3f(0), V3f(4, 0, 0), V3f(0, 2, 0)));
    ASSERT_EQ(scene.lightmap_coordinates.size(), scene.vertices.size());
    for (std::size_t i = 0; i < 3; ++i) {
        const V3f x = V3f(scene.origin) + scene.vertices[i];
        EXPECT_EQ(scene.lightmap_coordinates[i], V2f(x.x / 8, 1 - x.y / 8));
    }
}

TEST(GltfDraco, DamagedOnesAreRefused) {
    const GltfBuilder whole = draco_file();
    for (std::size_t size = 0; size < draco_triangle().size(); ++size) {
        GltfBuilder cut = whole;
        cut.file["bufferViews"].back()["byteLength"] = size;
        EXPECT_THAT(cut.fault(), HasSubstr("KHR_draco_mesh_compression")) << size << " bytes";
    }
    GltfBuilder fewer = whole;
    fewer.file["accessors"][0]["count"] = 2;
    EXPECT_THAT(fewer.fault(), HasSubstr("more triangles or vertices than its accessors"));
}

TEST(GltfDraco, AttributesHaveTheExpectedComponents) {
    const auto fault_if = [](const char* attribute, int id) {
        GltfBuilder file = draco_file();
        json& primitive = file.file["meshes"][0]["primitives"][0];
        primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"][attribute] = id;
        return file.fault();
    };
    EXPECT_THAT(fault_if("POSITION", 1), HasSubstr("POSITION has 2 components, expected 3"));
    EXPECT_THAT(fault_if("TEXCOORD_1", 0), HasSubstr("TEXCOORD_1 has 3 components, expected 2"));
    EXPECT_THAT(fault_if("NORMAL", 1), HasSubstr("NORMAL has 2 components, expected 3"));
}

}  // namespace
}  // namespace interflect
