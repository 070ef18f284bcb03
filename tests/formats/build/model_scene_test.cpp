#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interflect/core.h"
#include "interflect/formats/build/model.h"
#include "interflect/scene/faces/patch_area.h"
#include "tests/support/refusals.h"

namespace interflect {

using namespace detail;
namespace {

using Imath::V3d;

/// A unit square in two triangles, seen from above, and a triangle of the same material on its edge x = 1.
Mesh square_and_triangle() {
    Mesh mesh;
    mesh.name = "mesh 'tile'";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 1}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 1, 4, 2};
    return mesh;
}

Imath::M44d moved(const V3d& by) {
    Imath::M44d m;
    m.setTranslation(by);
    return m;
}

Model model_of(Mesh mesh, std::vector<Imath::M44d> places = {Imath::M44d()}) {
    Model model;
    model.file = "tiles.glb";
    model.materials.push_back({.name = "grey", .reflectance = Rgb(0.5f), .exitance = Rgb(0)});
    model.meshes.push_back(std::move(mesh));
    for (const auto& place : places) model.instances.push_back({0, place, 0});
    return model;
}

Scene read(Model model, const ReadOptions& options = {}) { return scene_of(std::move(model), options); }

V3d normal(const Scene& scene, const Patch& patch) {
    const auto x = [&](std::size_t i) { return V3d(scene.vertices[patch.vertices[i]]); };
    return (x(1) - x(0)).cross(x(2) - x(0)).normalized();
}

TEST(ModelScene, PairsOfTrianglesAreOnePatchOnEachSide) {
    const Scene scene = read(model_of(square_and_triangle()));
    ASSERT_EQ(scene.patches.size(), 4u);
    EXPECT_EQ(scene.vertices.size(), 5u);
    EXPECT_FALSE(scene.patches[0].is_triangle());
    EXPECT_TRUE(scene.patches[2].is_triangle());
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(scene.patches[i].other_side, i ^ 1u);
    EXPECT_EQ(normal(scene, scene.patches[0]), V3d(0, 0, 1));
    EXPECT_EQ(normal(scene, scene.patches[1]), V3d(0, 0, -1));
}

TEST(ModelScene, InstancesAreWeldedWhereTheyTouch) {
    const Scene scene = read(model_of(square_and_triangle(), {moved({0, 0, 0}), moved({0, 1, 0})}));
    EXPECT_EQ(scene.patches.size(), 8u);
    EXPECT_EQ(scene.vertices.size(), 8u);  // (0, 1, 0) and (1, 1, 0) are corners of both
}

TEST(ModelScene, AMirroredInstanceKeepsItsFront) {
    Imath::M44d mirror;
    mirror.setScale(V3d(-1, 1, 1));
    const Scene scene = read(model_of(square_and_triangle(), {mirror}));
    EXPECT_EQ(normal(scene, scene.patches[0]), V3d(0, 0, 1));
}

TEST(ModelScene, FarFromTheOriginNothingIsLost) {
    const V3d far(4'500'000, -5'200'000, 300);
    Model model = model_of(square_and_triangle(), {moved(far)});
    model.lights.push_back({{.name = "lamp", .kind = PointLight{.intensity = Rgb(100)}}, far + V3d(0.5, 0.25, 2)});
    const Scene scene = read(std::move(model));
    EXPECT_EQ(scene.origin + V3d(scene.vertices[2]), far + V3d(1, 1, 0));
    const auto& lamp = std::get<PointLight>(scene.luminaires.at(0).kind);
    EXPECT_EQ(scene.origin + V3d(lamp.position), far + V3d(0.5, 0.25, 2));
}

TEST(ModelScene, PolygonsAreSplitAsTheirShapeAsks) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}};
    mesh.indices = {0, 1, 2, 3, 4};
    mesh.face_sizes = {5};
    const Scene scene = read(model_of(mesh));
    double area = 0;
    for (std::size_t i = 0; i < scene.patches.size(); i += 2) area += patch_area(scene, scene.patches[i]);
    EXPECT_NEAR(area, 4 - 1.5, 1e-6);
}

TEST(ModelScene, BacksOfOneSidedLampsAreDark) {
    for (const bool back_emits : {true, false}) {
        Mesh mesh = square_and_triangle();
        mesh.back_emits = back_emits;
        Model model = model_of(mesh, {moved({0, 0, 0}), moved({0, 0, 3})});
        model.materials[0].exitance = Rgb(1000);
        const Scene scene = read(std::move(model));
        EXPECT_EQ(scene.materials.size(), back_emits ? 1u : 2u);
        for (std::size_t i = 0; i < scene.patches.size(); ++i) {
            const Material& material = scene.materials[scene.patches[i].material];
            EXPECT_EQ(material.exitance, Rgb(i % 2 == 0 || back_emits ? 1000.0f : 0.0f)) << i;
            EXPECT_EQ(material.reflectance, Rgb(0.5f));
        }
    }
}

TEST(ModelScene, FacesWithoutAreaAreLeftOutWithOneWarning) {
    Mesh mesh = square_and_triangle();
    mesh.indices.insert(mesh.indices.end(), {0, 1, 1, 2, 2, 2});
    const Scene scene = read(model_of(mesh));
    EXPECT_EQ(scene.patches.size(), 4u);
    ASSERT_EQ(scene.warnings.entries().size(), 1u);
    EXPECT_EQ(scene.warnings.entries()[0].count, 2);
    EXPECT_EQ(scene.warnings.entries()[0].where, "tiles.glb: mesh 'tile'");
}

struct BadModel {
    const char* name;
    void (*spoil)(Model&);
    const char* message;
};
void PrintTo(const BadModel& bad, std::ostream* out) { *out << bad.name; }

class BadModels : public testing::TestWithParam<BadModel> {};

TEST_P(BadModels, AreRefusedWithTheReason) {
    Model model = model_of(square_and_triangle());
    GetParam().spoil(model);
    try {
        scene_of(std::move(model), {});
        FAIL() << "it was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find("tiles.glb: "), 0u) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(
    With, BadModels,
    testing::Values(
        BadModel{"IndexOutOfRange", [](Model& m) { m.meshes[0].indices[4] = 5; },
                 "mesh 'tile': it uses vertex 5; expected indices below"},
        BadModel{"IndicesLeft", [](Model& m) { m.meshes[0].indices.pop_back(); }, "do not use all of its 8 indices"},
        BadModel{"FaceSizes",
                 [](Model& m) {
                     m.meshes[0].face_sizes = {4, 4};
                 },
                 "do not use all"},
        BadModel{"FaceOfTwo",
                 [](Model& m) {
                     m.meshes[0].face_sizes = {2, 7};
                 },
                 "a face has 2 vertices"},
        BadModel{"Material", [](Model& m) { m.meshes[0].material = 1; }, "material 1 does not exist"},
        BadModel{"Coordinates", [](Model& m) { m.meshes[0].texture_coordinates.resize(3); }, "3 texture coordinates"},
        BadModel{"LightmapCoordinates", [](Model& m) { m.meshes[0].lightmap_coordinates.resize(3); },
                 "3 lightmap coordinates"},
        BadModel{"Mesh", [](Model& m) { m.instances[0].mesh = 1; }, "does not exist"},
        BadModel{"Object", [](Model& m) { m.instances[0].object = 1; }, "does not exist"},
        BadModel{"NotFinite", [](Model& m) { m.meshes[0].positions[4].y = std::nan(""); }, "too far"},
        BadModel{"TooFar", [](Model& m) { m.meshes[0].positions[4].y = 1e30; }, "too far"},
        BadModel{"NoFace", [](Model& m) { m.meshes[0].indices.clear(); }, "the scene is empty"},
        BadModel{"NoArea",
                 [](Model& m) {
                     m.meshes[0].indices = {0, 1, 1};
                 },
                 "no usable face is left"}),
    testing::PrintToStringParamName());

TEST(ModelScene, TooManyFacesAreRefusedBeforeTheyAreMade) {
    ReadOptions options;
    options.max_patches = 5;
    EXPECT_EQ(testing_support::refused_setting([&] {
                  read(model_of(square_and_triangle(), {Imath::M44d(), moved({9, 0, 0})}), options);
              }),
              "max_patches");
    options.max_patches = 7;
    EXPECT_EQ(testing_support::refused_setting([&] {
                  read(model_of(square_and_triangle(), {Imath::M44d(), moved({9, 0, 0})}), options);
              }),
              "max_patches");
    options.max_patches = 8;
    EXPECT_EQ(read(model_of(square_and_triangle(), {Imath::M44d(), moved({9, 0, 0})}), options).patches.size(), 8u);
}

}  // namespace
}  // namespace interflect
