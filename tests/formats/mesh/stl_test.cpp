#include "interflect/formats/mesh/stl.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "tests/support/refusals.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

Scene parse_stl(const std::string& bytes, const ReadOptions& options = {}) {
    return read_stl_bytes(bytes, "part.stl", options);
}

const std::string facet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 2 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";

std::string binary(float y = 1, std::uint32_t count = 1) {
    std::string bytes(80, '\0');
    bytes.replace(0, 5, "solid");  // some programs write this in binary files
    bytes.append(reinterpret_cast<const char*>(&count), 4);
    const float numbers[12] = {0, 0, -1, 0, 0, 0, 2, 0, 0, 0, y, 0};
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    return bytes + std::string(2, '\x7f');
}

class StlForm : public testing::TestWithParam<std::string> {};
TEST_P(StlForm, GivesTheSameTriangle) {
    const Scene scene = parse_stl(GetParam());
    ASSERT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(patch_area(scene, scene.patches[0]), 1);
    EXPECT_EQ(PatchGeometry(scene, scene.patches[0]).normal(), V3f(0, 0, 1));  // from its corners, not from the file
    EXPECT_EQ(scene.materials[scene.patches[0].material].reflectance, Rgb(0.5f));
}
INSTANTIATE_TEST_SUITE_P(, StlForm, testing::Values("solid part\n" + facet + "endsolid part\n", binary()),
                         [](const auto& test) { return test.index == 0 ? "Text" : "Binary"; });

TEST(Stl, SolidsAreObjects) {
    const Scene scene =
        parse_stl("solid a lamp\n" + facet + "endsolid a lamp\nsolid\n" + facet + "endsolid\nsolid c\n" + facet);
    ASSERT_EQ(scene.patches.size(), 6u);
    EXPECT_EQ(scene.objects[scene.patches[0].object], "a lamp");
    EXPECT_EQ(scene.objects[scene.patches[2].object], "");
    EXPECT_EQ(scene.objects[scene.patches[4].object], "c");
}

TEST(Stl, EveryCutOfABinaryFileIsRefused) {
    const std::string whole = binary();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_NE(message_of([&] { parse_stl(whole.substr(0, size)); }), "no error") << size;
}

/// Each was refused.
TEST(Stl, VariantsOfOtherProgramsAreRead) {
    const std::string text = "solid part\n" + facet + "endsolid part\n", bom = "\xef\xbb\xbf";
    std::string upper = text;
    for (char& c : upper)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    for (const std::string& variant :
         {upper, "\n \r\n  " + text, bom + text, "solid " + std::string(1000, '/') + "\n" + facet, binary(1, 0)}) {
        const Scene scene = parse_stl(variant);
        ASSERT_EQ(scene.patches.size(), 2u) << variant.substr(0, 20);
        EXPECT_EQ(patch_area(scene, scene.patches[0]), 1);
        EXPECT_TRUE(scene.warnings.entries().empty());
    }
    const Scene longer = parse_stl(binary() + "\r\n");
    EXPECT_EQ(longer.patches.size(), 2u);
    ASSERT_EQ(longer.warnings.entries().size(), 1u);
    EXPECT_EQ(longer.warnings.entries()[0].kind, "surplus-data");
}

class StlBadText : public testing::TestWithParam<BadText> {};
TEST_P(StlBadText, IsNamedWithItsFault) {
    const std::string error = message_of([] { parse_stl(GetParam().text); });
    expect_in(error, "part.stl");
    expect_in(error, GetParam().expected);
}
INSTANTIATE_TEST_SUITE_P(
    , StlBadText,
    testing::Values(
        BadText{"Empty", "", "this is no STL file"}, BadText{"NoFacet", "solid a\nendsolid a\n", "the scene is empty"},
        BadText{"NoSolid", "solidity\nvertex 0 0 0\n", "is no word of an STL file"},
        BadText{"MoreTrianglesThanThereAre", binary(1, 2), "for each triangle that it counts"},
        BadText{"BillionTriangles", "x" + binary(1, 1000000000).substr(1), "for each triangle that it counts"},
        BadText{"NaN", binary(std::numeric_limits<float>::quiet_NaN()), "triangle 1 is not finite"},
        BadText{"Word", "solid a\nfacet\nvertex 0 x 0\n", ":3: expected a finite number, not 'x'"},
        BadText{"CutVertex", "solid a\nfacet\nvertex 0 0\n", ":3: a vertex has 2 coordinates"},
        BadText{"TwoVertices", "solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendloop\n", ":5: a facet must have three"},
        BadText{"Cut", "solid a\nfacet\nvertex 0 0 0\n", "the file ends within a facet"}),
    testing::PrintToStringParamName());

TEST(Stl, LimitOfPatchesIsNamed) {
    for (const std::string& bytes : {binary(), "solid\n" + facet})
        expect_in(message_of([&] { parse_stl(bytes, {.max_patches = 1}); }), "max_patches");
}

}  // namespace
}  // namespace interflect
