// Normals of vertices in OBJ, PLY, MGF and glTF files, and on their way through the scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "interflect/formats/mesh/obj/obj.h"
#include "interflect/formats/mesh/ply/ply.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/formats/mgf/write_mgf.h"
#include "interflect/prepare.h"
#include "tests/formats/gltf/builder.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// The normal at the corner of the first patch that lies at x; of length 0 if there is none.
V3f normal_at(const Scene& scene, const V3f& x) {
    for (const std::uint32_t v : scene.patches.at(0).vertices)
        if (v != none && (V3f(scene.origin) + scene.vertices[v] - x).length() < 1e-5f)
            return scene.normals.empty() ? V3f(0) : scene.normals[v];
    ADD_FAILURE() << "no such corner";
    return V3f(0);
}

/// A triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) whose normals are (0, 0, 1), (0.6, 0, 0.8) and (0, 0.6, 0.8).
void expect_normals(const Scene& scene) {
    constexpr float rounding = 4e-3f;
    EXPECT_LT((normal_at(scene, {0, 0, 0}) - V3f(0, 0, 1)).length(), rounding);
    EXPECT_LT((normal_at(scene, {1, 0, 0}) - V3f(0.6f, 0, 0.8f)).length(), rounding);
    EXPECT_LT((normal_at(scene, {0, 1, 0}) - V3f(0, 0.6f, 0.8f)).length(), rounding);
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
}

const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nvn 0.6 0 0.8\nvn 0 3 4\n";
const std::string mgf =
    "m grey =\n rd .5\nv a =\n p 0 0 0\n n 0 0 1\nv b =\n p 1 0 0\n n .6 0 .8\nv d =\n p 0 1 0\n n 0 .6 .8\nf a b d\n";

TEST(Normals, OfObj) { expect_normals(read_obj_text(obj + "f 1//1 2//2 3//3\n", "t.obj", {})); }
TEST(Normals, OfPly) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) text += std::string("property float ") + name + "\n";
    text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    expect_normals(read_ply_bytes(text + "0 0 0 0 0 1\n1 0 0 .6 0 .8\n0 1 0 0 .6 .8\n3 0 1 2\n", "t.ply", {}));
}
TEST(Normals, OfMgf) { expect_normals(read_mgf_text(mgf, "t.mgf", {})); }
TEST(Normals, OfGltf) {
    GltfBuilder builder;
    builder.add_triangle();
    const int normals = builder.add_vectors({{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0.6f, 0.8f}});
    builder.file["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
    expect_normals(builder.read());
}

/// A plane x + z = const scaled by 2 in x has the normal (1, 0, 2), not (2, 0, 1).
TEST(Normals, TransformByTheInverseTranspose) {
    GltfBuilder builder;
    builder.add_triangle()["scale"] = {2, 1, 1};
    builder.file["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        builder.add_vectors({{1, 0, 1}, {1, 0, 1}, {1, 0, 1}});
    const V3f n = normal_at(builder.read(), {2, 0, 0});
    EXPECT_LT((n - V3f(1, 0, 2).normalized()).length(), 4e-3f) << n.x << ' ' << n.y << ' ' << n.z;
}

TEST(Normals, ThatAreNotUsableAreIgnored) {
    const std::string bad = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan 0 1\nvn 0 0\nvn 0 0 0\n";
    EXPECT_TRUE(read_obj_text(bad + "f 1//1 2//2 3//3\n", "t.obj", {}).normals.empty());
    const Scene scene = read_obj_text(bad + "f 1//7 2//0 3//x\n", "t.obj", {});
    EXPECT_TRUE(scene.normals.empty());
    EXPECT_EQ(warning_kinds(scene), std::vector<std::string>{"missing-normals"});
}

/// Faces of one plane share vertices although their normals differ by rounding.
TEST(Normals, OfFlatFacesAreWelded) {
    const Scene scene = read_obj_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0.0001 0 1\nvn 0 0.0001 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n",
        "t.obj", {});
    EXPECT_EQ(scene.vertices.size(), 4u);
    EXPECT_EQ(scene.patches.size(), 2u) << "both sides of one square";
}

TEST(Normals, AreWrittenToMgf) {
    std::stringstream text;
    write_mgf(read_mgf_text(mgf, "t.mgf", {}), text, {}, {}, {});
    expect_normals(read_mgf_text(text.str(), "again.mgf", {}));
}

TEST(Normals, AreInterpolatedWhereFacesAreDivided) {
    const Scene scene = split_patches(read_mgf_text(mgf, "t.mgf", {}), 0.7f, 1000);
    ASSERT_EQ(scene.normals.size(), scene.vertices.size());
    for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
        const V3f x = V3f(scene.origin) + scene.vertices[v];
        const V3f expected = V3f(0.6f * x.x, 0.6f * x.y, 1 - 0.2f * (x.x + x.y)).normalized();
        EXPECT_LT((scene.normals[v] - expected).length(), 5e-3f);
    }
}

}  // namespace
}  // namespace interflect
