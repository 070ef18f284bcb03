// Damaged or hostile files are refused, with the name of the file and the place in it, before memory is allocated.
//
// Seen to fail when accessors are not checked against their views, when a node's second parent is not noticed, when
// paths are compared as text alone (a symbolic link then leaves the folder), and when the counts in Draco's data are
// trusted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>

#include <functional>

#include "interflect/image.h"
#include "interflect/load.h"
#include "tests/formats/gltf/builder.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using namespace detail;
using namespace testing_support;

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift & 0xff));
    return bytes;
}

std::string png_chunk(const std::string& content) {  // type and data
    return big_endian(static_cast<std::uint32_t>(content.size() - 4)) + content +
           big_endian(libdeflate_crc32(0, content.data(), content.size()));
}

/// Creates a PNG of 8 bit RGB that claims a size, with data of `bytes` zeros, deflated.
std::string png_of_zeros(std::uint32_t width, std::uint32_t height, std::size_t bytes) {
    const std::string zeros(bytes, '\0');
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    std::string deflated(libdeflate_zlib_compress_bound(compressor, bytes), '\0');
    deflated.resize(libdeflate_zlib_compress(compressor, zeros.data(), zeros.size(), deflated.data(), deflated.size()));
    libdeflate_free_compressor(compressor);
    return "\x89PNG\r\n\x1a\n" +
           png_chunk("IHDR" + big_endian(width) + big_endian(height) + std::string("\x08\x02\0\0\0", 5)) +
           png_chunk("IDAT" + deflated) + png_chunk("IEND");
}

struct GltfFault {
    const char* name;
    std::function<void(GltfBuilder&)> damage;  ///< Of a file with a triangle.
    const char* expected;                      ///< Part of the message.
};

void PrintTo(const GltfFault& fault, std::ostream* out) { *out << fault.name; }

class GltfFaults : public testing::TestWithParam<GltfFault> {};

TEST_P(GltfFaults, AreNamed) {
    GltfBuilder file;
    file.add_triangle();
    file.file["meshes"][0]["name"] = "chair";
    GetParam().damage(file);
    const std::string error = file.fault();
    EXPECT_THAT(error, testing::StartsWith("test.glb: "));
    EXPECT_THAT(error, HasSubstr(GetParam().expected));
}

/// Sets the value at a JSON pointer, for example "/accessors/0/count".
std::function<void(GltfBuilder&)> put(const char* pointer, const json& value) {
    return [=](GltfBuilder& file) { file.file[json::json_pointer(pointer)] = value; };
}

std::function<void(GltfBuilder&)> index(std::vector<std::uint16_t> values) {
    return [=](GltfBuilder& file) { file.file["meshes"][0]["primitives"][0]["indices"] = file.add_indices(values); };
}

std::function<void(GltfBuilder&)> show_image(const std::string& bytes) {
    return [=](GltfBuilder& file) {
        file.file["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = file.add_image(bytes);
    };
}

/// Indices without data are zero.
std::function<void(GltfBuilder&)> index_zeros(std::uint64_t count) {
    return [=](GltfBuilder& file) {
        file.file["meshes"][0]["primitives"][0]["indices"] =
            file.add("accessors", {{"componentType", 5125}, {"count", count}, {"type", "SCALAR"}});
    };
}

void use_meshopt(GltfBuilder& file, const char* mode, std::uint64_t count, std::uint64_t stride) {
    file.file["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0}, {"byteLength", 36}, {"mode", mode}, {"count", count}, {"byteStride", stride}};
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfFaults,
    testing::Values(
        GltfFault{"OldVersion", put("/asset/version", "1.0"), "asset.version is '1.0'"},
        GltfFault{"UnknownExtension", put("/extensionsRequired", {"ACME_walls", "ACME_doors"}),
              "extensions that are not read: ACME_walls, ACME_doors"},
        GltfFault{"NoArray", put("/meshes", 3), "meshes is not an array"},
        GltfFault{"NoObject", put("/nodes/0", "a"), "nodes[0] is not an object"},
        GltfFault{"NoSuchScene", put("/scene", 7), "scene is 7, but there are 1"},
        GltfFault{"NoSuchNode", put("/scenes/0/nodes", {0, 5}), "nodes is 5"},
        GltfFault{"NoSuchMesh", put("/nodes/0/mesh", 9), "mesh is 9, but there are 1"},
        GltfFault{"NegativeIndex", put("/nodes/0/mesh", -1), "mesh is not a whole number"},
        GltfFault{"FractionalIndex", put("/nodes/0/mesh", 0.5), "mesh is not a whole number"},
        GltfFault{"IndexIsText", put("/nodes/0/mesh", "0"), "mesh is not a whole number"},
        GltfFault{"NodeOfItself", put("/nodes/0/children", {0}), "their own ancestors"},
        GltfFault{"NodeTwice", put("/scenes/0/nodes", {0, 0}), "is in it twice"},
        GltfFault{"CyclicNodes", [](GltfBuilder& f) { f.file["nodes"].push_back({{"children", {2}}}); f.file["nodes"].push_back({{"children", {1}}}); },
              "their own ancestors"},
        GltfFault{"TwoParents", [](GltfBuilder& f) { for (int i = 0; i < 2; ++i) f.add_node({{"children", {0}}}); },
              "nodes[0]: it is the child of two nodes"},
        GltfFault{"MatrixTooShort", put("/nodes/0/matrix", {1, 2, 3}), "nodes[0]: matrix has not 16 numbers"},
        GltfFault{"Perspective", put("/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), "not affine"},
        GltfFault{"NoRotation", put("/nodes/0/rotation", {0, 0, 0, 0}), "quaternion of length 0"},
        GltfFault{"FarAway", put("/nodes/0/translation", {1e30, 0, 0}), "meshes[0] 'chair'.primitives[0]"},
        GltfFault{"NoSuchAccessor", put("/meshes/0/primitives/0/attributes/POSITION", 99), "POSITION is 99"},
        GltfFault{"PositionsOfTwo", put("/meshes/0/primitives/0/attributes/POSITION", 1), "type 'VEC2', expected VEC3"},
        GltfFault{"NoSuchMode", put("/meshes/0/primitives/0/mode", 7), "its mode is 7"},
        GltfFault{"TwoCorners", put("/accessors/0/count", 2), "2 vertices, expected a multiple of 3"},
        GltfFault{"FourIndices", index({0, 1, 2, 0}), "4 indices, expected a multiple of 3"},
        GltfFault{"TooManyElements", put("/accessors/0/count", 4), "end beyond its view"},
        GltfFault{"EnormousCount", put("/accessors/0/count", 1'000'000'000), "end beyond its view"},
        GltfFault{"CountBeyondIntegers", put("/accessors/0/count", 1e19), "count is not a whole number"},
        GltfFault{"OffsetBeyondView", put("/accessors/0/byteOffset", 4), "end beyond its view"},
        GltfFault{"EnormousOffset", put("/accessors/0/byteOffset", 1'099'511'627'776), "end beyond its view"},
        GltfFault{"EnormousStride", put("/bufferViews/0/byteStride", 1'099'511'627'776), "end beyond its view"},
        GltfFault{"StrideTooSmall", put("/bufferViews/0/byteStride", 4), "byteStride 4 is less than"},
        GltfFault{"UnknownComponents", put("/accessors/0/componentType", 5130), "component type 5130"},
        GltfFault{"NoData", [](GltfBuilder& f) { f.file["accessors"][0].erase("bufferView"); }, "has no data"},
        GltfFault{"ViewBeyondBuffer", put("/bufferViews/0/byteLength", 1000), "end beyond its buffer"},
        GltfFault{"ViewOffsetBeyondBuffer", put("/bufferViews/0/byteOffset", 1'000'000), "end beyond its buffer"},
        GltfFault{"NoSuchBuffer", put("/bufferViews/0/buffer", 1), "buffer is 1, but there are 1"},
        GltfFault{"LyingBuffer", put("/buffers", {{{"byteLength", 1000}}}), "byteLength is 1000, but there are"},
        GltfFault{"BufferWithoutData", [](GltfBuilder& f) { f.file["buffers"] = {{{"byteLength", 60}}, {{"byteLength", 36}}}; f.file["bufferViews"][0]["buffer"] = 1; },
              "buffers[1]: it has no uri"},
        GltfFault{"BadBase64", put("/buffers", {{{"byteLength", 60}, {"uri", "data:;base64,A*"}}}), "no valid base64"},
        GltfFault{"IndexBeyondVertices", index({0, 1, 3}), "index 3 is outside the 3 vertices"},
        GltfFault{"RestartIndex", index({0, 1, 65535}), "index 65535 is outside the 3 vertices"},
        GltfFault{"BillionIndices", index_zeros(999'999'999), "max_patches"},
        GltfFault{"FloatIndices", put("/meshes/0/primitives/0/indices", 0), "expected SCALAR"},
        GltfFault{"SparseBeyondEnd", [](GltfBuilder& f) {
                  const int places = f.add_view(std::string("\x03\0", 2)), values = f.add_view(std::string(12, '\0'));
                  f.file["accessors"][0]["sparse"] = {{"count", 1}, {"indices", {{"bufferView", places}, {"componentType", 5123}}}, {"values", {{"bufferView", values}}}};
              }, "element 3 is replaced, but there are 3"},
        GltfFault{"SparseOutOfOrder", [](GltfBuilder& f) {
                  const int places = f.add_view(std::string("\x01\0\x01\0", 4)), values = f.add_view(std::string(24, '\0'));
                  f.file["accessors"][0]["sparse"] = {{"count", 2}, {"indices", {{"bufferView", places}, {"componentType", 5123}}}, {"values", {{"bufferView", values}}}};
              }, "index 1 follows 1; indices must ascend"},
        GltfFault{"SparseOfNoComponents", [](GltfBuilder& f) { f.file["accessors"][0]["sparse"] = {{"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", 1}}}, {"values", {{"bufferView", 0}}}}; }, "its componentType is unknown"},
        GltfFault{"SparseOfTerabytes", [](GltfBuilder& f) {
                  f.file["accessors"][0].erase("bufferView");
                  f.file["accessors"][0].update({{"count", 999'999'999'999}, {"sparse", {{"count", 0}, {"indices", {{"bufferView", 0}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}}}});
              }, "max_model_bytes"},
        GltfFault{"CoordinatesAreFewer", [](GltfBuilder& f) { show_image(png_of_zeros(1, 1, 4))(f); put("/accessors/1/count", 2)(f); }, "2 texture coordinates for 3 vertices"},
        GltfFault{"NormalsAreFewer", [](GltfBuilder& f) { f.file["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = f.add_vectors({{0, 0, 1}}); }, "1 normals for 3 vertices"},
        GltfFault{"MeshoptDamaged", [](GltfBuilder& f) { use_meshopt(f, "ATTRIBUTES", 3, 12); }, "its data are damaged"},
        GltfFault{"MeshoptTerabytes", [](GltfBuilder& f) { use_meshopt(f, "ATTRIBUTES", 1ull << 40, 256); }, "max_model_bytes"},
        GltfFault{"MeshoptStride", [](GltfBuilder& f) { use_meshopt(f, "ATTRIBUTES", 3, 6); }, "cannot have byteStride 6"},
        GltfFault{"MeshoptMode", [](GltfBuilder& f) { use_meshopt(f, "QUADS", 3, 12); }, "its mode is unknown"},
        GltfFault{"InstancesDiffer", [](GltfBuilder& f) { f.file["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 0}, {"SCALE", f.add_vectors({{1, 1, 1}})}}; },
              "differ in their counts"},
        GltfFault{"BillionInstances", [](GltfBuilder& f) { f.file["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = f.add("accessors", {{"componentType", 5126}, {"count", 1'000'000'000}, {"type", "VEC3"}}); },
              "max_patches"},
        GltfFault{"NegativeColour", [](GltfBuilder& f) { f.file["materials"][0]["emissiveFactor"] = {-1, 0, 0}; }, "the channel -1"},
        GltfFault{"EmitsTooMuch", [](GltfBuilder& f) { f.file["materials"][0] = {{"emissiveFactor", {1, 1, 1}}, {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e20}}}}}}; }, "materials[0]: its exitance"},
        GltfFault{"NoImage", show_image("text"), "images[0]: cannot read this image"},
        GltfFault{"HugeTexture", show_image(png_of_zeros(100'000, 100'000, 10)), "100000 x 100000 pixels"},
        GltfFault{"LongTexture", show_image(png_of_zeros(100'000, 1, 300'001)), "100000 x 1 pixels"},
        GltfFault{"EmptyTexture", show_image(png_of_zeros(0, 1, 10)), "cannot read this image"},
        GltfFault{"CutTexture", show_image(png_of_zeros(1000, 1000, 100)), "cannot read this image"},
        GltfFault{"LightOfNoType", [](GltfBuilder& f) { f.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}); f.file["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "area"}}}; },
              "not point, spot or directional"},
        GltfFault{"ConeTooWide", [](GltfBuilder& f) { f.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}); f.file["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}}; },
              "its cone goes from 0 to 2"},
        GltfFault{"CameraOfNoWidth", [](GltfBuilder& f) { f.add_node({{"camera", 0}}); f.file["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 4}}}}}; },
              "nodes[1]: its camera"}),
    [](const auto& fault) { return fault.param.name; });

/// A PNG whose header claims one pixel, and whose data inflate to 256 MiB: libspng stops after the pixel.
TEST(GltfBadInput, DataBeyondAnImageAreNotInflated) {
    GltfBuilder file;
    file.add_triangle();
    show_image(png_of_zeros(1, 1, std::size_t{1} << 28))(file);
    file.fault();  // at once, refused or not
}

TEST(GltfBadInput, AGlbIsRefusedWhereverItIsCut) {
    GltfBuilder file;
    file.add_triangle();
    const std::string whole = file.glb();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW(read_gltf_bytes(whole.substr(0, size), "cut.glb", {}), InputError) << size << " bytes";
}

TEST(GltfBadInput, JsonOfAnyDepthIsRefusedOrRead) {
    const int depth = is_sanitized ? 100'000 : 1'000'000;  // frames are larger under sanitizers
    for (const char* open : {"[", "{\"a\":"}) {
        std::string text = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
        for (int i = 0; i < depth; ++i) text += open;
        EXPECT_THROW(read_gltf_bytes(text, "deep.gltf", {}), InputError);
    }
}

// ---- Paths

class GltfPaths : public testing::Test {
  protected:
    GltfPaths() {
        fs::create_directories(folder.path() / "scene/parts");
        folder.write("outside.bin", binary());
        folder.write("scene/inside.bin", binary());
        folder.write("scene/parts/my inside.bin", binary());
        fs::create_symlink(folder.path() / "outside.bin", folder.path() / "scene/link.bin");
        fs::create_directory_symlink(folder.path(), folder.path() / "scene/away");
    }

    static GltfBuilder triangle() {
        GltfBuilder file;
        file.add_triangle();
        return file;
    }
    static std::string binary() { return triangle().binary; }

    /// Returns the message for a file whose buffer has that URI; empty if the file is read.
    std::string fault(const std::string& uri, const ReadOptions& options = {}) {
        GltfBuilder file = triangle();
        file.file["buffers"] = {{{"uri", uri}, {"byteLength", binary().size()}}};
        const fs::path path = folder.write("scene/scene.gltf", file.file.dump());
        try {
            const Scene scene = load_scene(path, options);
            EXPECT_EQ(scene.files.size(), 2u);
            return "";
        } catch (const InputError& error) {
            return error.what();
        }
    }

    TemporaryFolder folder;
};

TEST_F(GltfPaths, WithinTheFolderAreRead) {
    for (const char* uri : {"inside.bin", "./inside.bin", "parts/my%20inside.bin", "parts/../inside.bin"})
        EXPECT_EQ(fault(uri), "") << uri;
}

TEST_F(GltfPaths, OutsideAreRefusedUnlessAllowed) {
    const std::string absolute = (folder.path() / "outside.bin").string();
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("parts/../../outside.bin"), std::string("%2e%2e/outside.bin"),
          std::string("link.bin"), std::string("away/outside.bin"), absolute}) {
        EXPECT_THAT(fault(uri), HasSubstr("buffers[0]: ")) << uri;
        EXPECT_THAT(fault(uri), HasSubstr("outside_files")) << uri;
        EXPECT_EQ(fault(uri, {.outside_files = true}), "") << uri;
    }
}

TEST_F(GltfPaths, OfOtherKindsAreRefused) {
    for (const char* uri :
         {"http://example.com/inside.bin", "file:///etc/passwd", "C:inside.bin", "", "inside.bin%00x"})
        EXPECT_THAT(fault(uri, {.outside_files = true}), HasSubstr("scene.gltf: buffers[0]: '")) << uri;
    EXPECT_THAT(fault("nowhere.bin"), HasSubstr("no such file"));
    EXPECT_THAT(fault("parts"), HasSubstr("this is a folder"));
    EXPECT_THAT(fault("inside.bin", {.max_model_bytes = 40}), HasSubstr("at most"));
    EXPECT_THAT(fault("inside.bin", {.max_include_depth = 0}), HasSubstr("max_include_depth"));
}

}  // namespace
}  // namespace interflect
