// Prepared scenes, view factors, lightmaps and vertex light have the same bits for any number of threads.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "interflect/export.h"
#include "interflect/generate.h"
#include "interflect/load.h"
#include "interflect/prepare.h"
#include "interflect/solve.h"
#include "interflect/view_factors.h"
#include "tests/formats/gltf/builder.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/scenes/scenes.h"
#include "tests/threads/on_threads.h"

namespace interflect {
namespace {

using namespace testing_support;

TEST(SameBitsOfPreparedScenes, CutAtContacts) {
    const Scene scene = make_boxes({.boxes = 12});
    expect_same_bits([&] {
        const Scene cut = cut_at_contacts(scene);
        std::vector<std::uint32_t> patches;
        for (const Patch& patch : cut.patches)
            patches.insert(patches.end(), patch.vertices.begin(), patch.vertices.end());
        return std::tuple(cut.vertices, patches);
    });
}

TEST(SameBitsOfViewFactors, BetweenPatches) {
    const Scene scene = furnished_room();
    std::vector<FaceGroup> groups;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) groups.push_back({std::to_string(p), {p}});
    expect_same_bits([&] {
        const ViewFactors factors = view_factors(scene, groups, {.rays = 100'000});
        return std::tuple(factors.columns, factors.values, factors.errors);
    });
}

SolveOptions few_rays() {
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 30'000;
    return options;
}

/// Contents of the files of a bake of a room.
class SameBitsOfBakes : public testing::TestWithParam<Shading> {
  protected:
    void expect_same_files(ExportOptions options) {
        const Scene scene = furnished_room();
        const Solution solution = solve(scene, RayCaster(scene), few_rays());
        options.bake.shading = GetParam();
        options.bake.samples = 4;
        const ExportFormat& glb = require_export_format("room.glb");
        expect_same_bits([&] {
            std::vector<std::string> contents;
            for (const ExportedFile& file : glb.make("room.glb", scene, solution, options))
                contents.push_back(file.bytes);
            return contents;
        });
    }
};
INSTANTIATE_TEST_SUITE_P(Shadings, SameBitsOfBakes, testing::Values(Shading::smooth, Shading::hybrid, Shading::gather),
                         [](const auto& test) { return label(test.param); });

TEST_P(SameBitsOfBakes, OfLightmaps) {
    ExportOptions options;
    options.lightmap.emplace();
    options.lightmap->texels_per_metre = 10;
    expect_same_files(options);
}

TEST_P(SameBitsOfBakes, OfVertices) {
    ExportOptions options;
    options.vertices.max_triangles = 1000;
    expect_same_files(options);
}

/// Adds a square of 3 m at a height, which faces up or down.
void add_square(GltfBuilder& file, float height, bool faces_up, json material) {
    const int positions = file.add_vectors({{0, height, 0}, {3, height, 0}, {3, height, 3}, {0, height, 3}});
    const int indices = file.add_indices(faces_up ? std::vector<std::uint16_t>{0, 2, 1, 0, 3, 2}
                                                  : std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3});
    const int mesh = file.add_mesh({{"attributes", {{"POSITION", positions}}},
                                    {"indices", indices},
                                    {"material", file.add("materials", std::move(material))}});
    file.add_node({{"mesh", mesh}});
}

TEST(SameBitsOfKeptFiles, OfLightmaps) {
    const json paint = {{"metallicFactor", 0}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}};
    GltfBuilder file;
    add_square(file, 0, true, {{"pbrMetallicRoughness", paint}});
    add_square(file, 2, false, {{"pbrMetallicRoughness", paint}, {"emissiveFactor", {1, 1, 1}}});
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "threads-kept.glb";
    std::ofstream(path, std::ios::binary) << file.glb();
    const Scene scene = load_scene(path);
    const Solution solution = solve(scene, RayCaster(scene), few_rays());
    ExportOptions options;
    options.lightmap.emplace();
    options.bake.samples = 4;
    Warnings warnings;
    options.warnings = &warnings;
    const ExportFormat& glb = require_export_format("lit.glb");
    expect_same_bits([&] { return glb.make("lit.glb", scene, solution, options).back().bytes; });
    for (const Warnings::Entry& entry : warnings.entries()) EXPECT_NE(entry.kind, "source-file") << entry.message;
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace interflect
