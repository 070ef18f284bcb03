// Lightmaps in the glTF file of the scene: awkward files. tests/python/lit_files_test.py compares the light with closed
// forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "interflect/export.h"
#include "interflect/load.h"
#include "tests/exports/lightmap/lightmaps.h"
#include "tests/formats/gltf/builder.h"

namespace interflect {

using namespace detail;
namespace {

using lightmap_testing::at;
using lightmap_testing::uniform;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing_support::GltfBuilder;
using testing_support::json;

class KeptFiles : public testing::Test {
  protected:
    const std::filesystem::path folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("kept-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    Warnings warnings_;

    KeptFiles() { std::filesystem::create_directories(folder_); }
    ~KeptFiles() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const GltfBuilder& file) const {
        std::ofstream(folder_ / "scene.glb", std::ios::binary) << file.glb();
        return folder_ / "scene.glb";
    }
    Scene lit(const std::filesystem::path& source, const char* extension = ".glb") {
        const Scene scene = load_scene(source);
        ExportOptions options = at(2);
        options.warnings = &warnings_;
        export_solution(folder_ / ("lit" + std::string(extension)), scene, uniform(scene, 100), options);
        return load_scene(folder_ / ("lit" + std::string(extension)));
    }
    std::vector<std::string> warning_kinds() const {
        std::vector<std::string> kinds;
        for (const Warnings::Entry& entry : warnings_.entries()) kinds.push_back(entry.kind);
        return kinds;
    }
};

std::vector<V3f> positions_of(const Scene& scene) {
    std::vector<V3f> positions;
    for (std::size_t p = 0; p < scene.patches.size(); ++p)
        for (const V3f& corner : testing_support::corners(scene, p)) positions.push_back(corner);
    return positions;
}

void expect_same_surfaces(const Scene& lit, const Scene& scene) {
    EXPECT_EQ(positions_of(lit), positions_of(scene));
    EXPECT_EQ(lit.objects, scene.objects);
    ASSERT_EQ(lit.materials.size(), scene.materials.size());
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        EXPECT_EQ(lit.materials[m].name, scene.materials[m].name);
        EXPECT_EQ(lit.materials[m].reflectance, scene.materials[m].reflectance);
    }
}

TEST_F(KeptFiles, WithCompressedOrTexturedMeshesHaveTheSameSurfaces) {
    for (const char* name : {"draco.glb", "meshopt.glb", "textured.gltf"})
        for (const char* extension : {".glb", ".gltf"}) {
            SCOPED_TRACE(std::string(name) + " as " + extension);
            const std::filesystem::path source = std::filesystem::path(INTERFLECT_SEEDS) / name;
            const Scene scene = load_scene(source), kept = lit(source, extension);
            expect_same_surfaces(kept, scene);
            EXPECT_THAT(warning_kinds(), Not(Contains("source-file")));
        }
}

TEST_F(KeptFiles, WithCopiesOfOneNodeGetNoLightmapThere) {
    GltfBuilder file;
    json& node = file.add_triangle();
    const int moves = file.add_vectors({{0, 0, 0}, {5, 0, 0}});
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = moves;
    file.file["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    file.add_triangle();
    const Scene kept = lit(write(file));
    EXPECT_EQ(kept.patches.size(), 6);
    EXPECT_THAT(warning_kinds(), Contains("lightmap-instances"));
}

TEST_F(KeptFiles, WithMissingMaterialsAndIndicesAreLit) {
    GltfBuilder file;
    file.add_node({{"mesh", file.add_mesh({{"attributes",
                                            {{"POSITION", file.add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}}})}});
    const Scene kept = lit(write(file), ".gltf");
    EXPECT_EQ(kept.patches.size(), 2);
    std::ifstream text(folder_ / "lit.gltf");
    EXPECT_TRUE(json::parse(text)["meshes"][0]["primitives"][0]["attributes"].contains("TEXCOORD_1"));
    EXPECT_THAT(warning_kinds(), IsEmpty());
}

TEST_F(KeptFiles, WithFanAroundAnEdgeOfChartsHaveTheSameSurfaces) {
    GltfBuilder file;  // a pyramid without its base: each side is a chart, so vertices are copied
    const int positions = file.add_vectors({{0, 0, 2}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}});
    const int indices = file.add_indices({0, 1, 2, 3, 4, 1});
    file.add_node(
        {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", 6}})}});
    const std::filesystem::path source = write(file);
    expect_same_surfaces(lit(source), load_scene(source));
    EXPECT_THAT(warning_kinds(), IsEmpty());
}

TEST_F(KeptFiles, WithDeepValuesAreWrittenAnew) {
    GltfBuilder file;
    file.add_triangle();
    json deep = 1;
    for (int i = 0; i < 1010; ++i) deep = json::array({std::move(deep)});
    file.file["extras"] = std::move(deep);
    lit(write(file));
    EXPECT_THAT(warning_kinds(), ElementsAre("source-file"));
}

TEST_F(KeptFiles, WithInvalidPartsThatTheReaderSkipsAreRefused) {
    GltfBuilder file;
    file.add_triangle();
    file.file["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", "none"}}};
    const std::filesystem::path source = write(file);
    EXPECT_THROW(lit(source), InputError);
}

TEST_F(KeptFiles, WithSolidsThatAreTurnedInsideOutShowTheLightOfTheirOutside) {
    GltfBuilder file;  // a board whose faces have their fronts inside
    std::vector<V3f> corners;
    for (const float z : {0.0f, 0.01f})
        for (const float y : {0.0f, 1.0f})
            for (const float x : {0.0f, 1.0f}) corners.push_back({x, y, z});
    const int positions = file.add_vectors(corners);
    const int indices = file.add_indices(
        {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3});
    file.add_node({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
    const Scene scene = load_scene(write(file));
    Solution solution = uniform(scene, 100);
    int narrow = 0;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        if (p < scene.patches[p].other_side) {
            const V3f& normal = PatchGeometry(scene, scene.patches[p]).normal();
            const bool has_seam = normal.x > 0.9f;
            narrow += has_seam;
            solution.irradiance[ElementIndex(p.value)] = Rgb(has_seam ? 5 : 1);  // light that leaked in
        }
    EXPECT_EQ(narrow, 1);
    ExportOptions options = at(20);
    export_solution(folder_ / "lit.glb", scene, solution, options);
    const Image light = read_image(folder_ / "lit.lightmap-0.exr");
    for (const Rgb& texel : light.pixels)
        if (texel != Rgb(0)) {
            EXPECT_NEAR(texel.y, light.at(0, 0).y, 1e-3f * light.at(0, 0).y);
        }
}

/// A negative scale turns the order of corners around and keeps the front. Seen to fail (1) if it swaps both sides.
TEST_F(KeptFiles, WithMirroredNodesShowTheLightOfTheirFront) {
    GltfBuilder file;
    file.add_triangle()["scale"] = {-1, 1, 1};
    const Scene scene = load_scene(write(file));
    Solution solution = uniform(scene, 1);
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        if (PatchGeometry(scene, scene.patches[p]).normal().z > 0.9f)
            solution.irradiance[ElementIndex(p.value)] = Rgb(100);
    export_solution(folder_ / "lit.glb", scene, solution, at(20));
    const Image light = read_image(folder_ / "lit.lightmap-0.exr");
    for (const Rgb& texel : light.pixels)
        if (texel != Rgb(0)) {
            ASSERT_NEAR(texel.y, 100, 0.1);
        }
}

}  // namespace
}  // namespace interflect
