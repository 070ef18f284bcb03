#include "interflect/formats/mesh/ply/ply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "tests/support/refusals.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

Scene parse_ply(const std::string& bytes, const ReadOptions& options = {}) {
    return read_ply_bytes(bytes, "part.ply", options);
}

std::string header(const std::string& form, const std::string& vertex = "4", const std::string& face = "1") {
    return "ply\nformat " + form + " 1.0\ncomment made by hand\nelement vertex " + vertex +
           "\nproperty float x\nproperty double y\nproperty int z\nelement face " + face +
           "\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n";
}
const std::string ply_square = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n", ply_face = "7 4 0 1 2 3\n";

template <class Number>
void append(std::string& bytes, Number value, std::endian order) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (order != std::endian::native) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
}

std::string binary(std::endian order) {
    std::string bytes = header(order == std::endian::big ? "binary_big_endian" : "binary_little_endian");
    for (const auto& [x, y] : {std::pair{0.f, 0.}, {2.f, 0.}, {2.f, 1.}, {0.f, 1.}}) {
        append(bytes, x, order);
        append(bytes, y, order);
        append(bytes, std::int32_t{0}, order);
    }
    bytes += "\7\4";
    for (std::int32_t i = 0; i < 4; ++i) append(bytes, i, order);
    return bytes;
}

class PlyForm : public testing::TestWithParam<std::string> {};
TEST_P(PlyForm, GivesTheSameFace) {
    const Scene scene = parse_ply(GetParam());
    ASSERT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(patch_area(scene, scene.patches[0]), 2);
    EXPECT_EQ(PatchGeometry(scene, scene.patches[0]).normal(), V3f(0, 0, 1));
    EXPECT_EQ(scene.materials[scene.patches[0].material].reflectance, Rgb(0.5f));
}
std::string form_name(const testing::TestParamInfo<std::string>& form) {
    constexpr std::array names{"Text", "LittleEndian", "BigEndian"};
    return names.at(form.index);
}
INSTANTIATE_TEST_SUITE_P(, PlyForm,
                         testing::Values(header("ascii") + ply_square + ply_face, binary(std::endian::little),
                                         binary(std::endian::big)),
                         form_name);

TEST(Ply, DataAfterTheLastElementGivesAWarning) {
    const auto kinds = [](const std::string& bytes) {
        const Scene scene = parse_ply(bytes);
        std::vector<std::string> found;
        for (const Warnings::Entry& warning : scene.warnings.entries()) found.push_back(warning.kind);
        return found;
    };
    const std::vector<std::string> surplus = {"surplus-data"};
    EXPECT_EQ(kinds(header("ascii") + ply_square + ply_face + ply_face), surplus);
    EXPECT_EQ(kinds(binary(std::endian::little) + "\1"), surplus);
    EXPECT_EQ(kinds(header("ascii") + ply_square + ply_face + " \r\n\n"), std::vector<std::string>());
}

TEST(Ply, EveryCutOfABinaryFileIsRefused) {
    const std::string whole = binary(std::endian::little);
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_NE(message_of([&] { parse_ply(whole.substr(0, size)); }), "no error") << size;
}

std::string coloured(const std::string& colours) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty "
           "uchar red\n"
           "property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar uint "
           "vertex_index\nend_header\n" +
           colours + "3 0 1 2\n";
}

TEST(Ply, OneColourOfAllVerticesIsTheReflectance) {
    const Scene scene = parse_ply(coloured("0 0 0 188 0 255\n1 0 0 188 0 255\n0 1 0 188 0 255\n"));
    const Rgb reflectance = scene.materials[scene.patches[0].material].reflectance;
    EXPECT_NEAR(reflectance.x, 0.5029, 1e-3);  // from sRGB 188
    EXPECT_EQ(reflectance.y, 0);
    EXPECT_FLOAT_EQ(reflectance.z, 0.99f);
    EXPECT_TRUE(scene.warnings.entries().empty());
    const Scene mixed = parse_ply(coloured("0 0 0 188 0 255\n1 0 0 188 0 255\n0 1 0 188 0 0\n"));
    EXPECT_EQ(mixed.materials[mixed.patches[0].material].reflectance, Rgb(0.5f));
    EXPECT_EQ(mixed.warnings.entries().at(0).kind, "vertex-colours");
}

const std::string strips_header =
    "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
    "property list int int vertex_indices\nend_header\n";

/// Two strips of a plane, the second one with a repeated vertex, which makes a triangle without area.
/// The scene was empty.
TEST(Ply, TriangleStripsAlternateTheirOrientation) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\n" + strips_header;
    for (const auto& [x, y] : {std::pair{0.f, 0.f}, {3.f, 0.f}, {0.f, 1.f}, {3.f, 1.f}, {0.f, 3.f}}) {
        append(bytes, x, std::endian::little);
        append(bytes, y, std::endian::little);
        append(bytes, 0.f, std::endian::little);
    }
    for (const std::int32_t i : {9, 0, 1, 2, 3, -1, 2, 3, 4, 4}) append(bytes, i, std::endian::little);
    const Scene scene = parse_ply(bytes);
    double area = 0;
    for (std::size_t i = 0; i < scene.patches.size(); i += 2) {
        area += patch_area(scene, scene.patches[i]);
        EXPECT_EQ(PatchGeometry(scene, scene.patches[i]).normal(), V3f(0, 0, 1)) << i;
    }
    EXPECT_FLOAT_EQ(static_cast<float>(area), 3 + 3);
    EXPECT_TRUE(scene.warnings.entries().empty());
}

TEST(Ply, StripsMustReferToVertices) {
    const std::string text = "ply\nformat ascii 1.0\n" + strips_header + "0 0 0\n3 0 0\n0 1 0\n3 1 0\n0 3 0\n4 0 1 2 ";
    expect_in(message_of([&] { parse_ply(text + "5\n"); }), "a face has vertex 5, but there are 5");
    expect_in(message_of([&] { parse_ply(text + "-2\n"); }), "-2 is no number of a vertex");
    expect_in(message_of([&] { parse_ply(text + "3\n", {.max_patches = 1}); }), "max_patches");
}

/// Was read as the next face, and refused.
TEST(Ply, ValuesBeyondThoseOfTheHeaderAreSkippedIfElementsHaveLines) {
    const Scene scene = parse_ply(header("ascii", "4", "2") + ply_square + "7 3 0 1 2 9 9 9 1\n\n7 3 0 2 3 9 9 9 1\n");
    ASSERT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(patch_area(scene, scene.patches[0]), 2);
    ASSERT_EQ(scene.warnings.entries().size(), 1u);
    EXPECT_EQ(scene.warnings.entries()[0].kind, "surplus-data");
    EXPECT_EQ(scene.warnings.entries()[0].count, 2u);
    // Elements over several lines, and several on a line.
    for (const std::string body :
         {"0 0\n0 2 0\n0 2 1 0\n0 1 0\n7 4\n0 1 2 3\n", "0 0 0 2 0 0 2 1 0 0 1 0\n7 4 0 1 2 3"}) {
        const Scene loose = parse_ply(header("ascii") + body);
        ASSERT_EQ(loose.patches.size(), 2u);
        EXPECT_EQ(patch_area(loose, loose.patches[0]), 2);
        EXPECT_TRUE(loose.warnings.entries().empty());
    }
}

/// An exporter of Blender wrote its comment without the keyword. The file was refused.
TEST(Ply, UnknownLinesOfTheHeaderAreSkipped) {
    std::string text = header("ascii") + ply_square + ply_face;
    text.replace(text.find("comment"), 7, "Created");
    const Scene scene = parse_ply(text);
    EXPECT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(scene.warnings.entries().at(0).kind, "unsupported-entity");
}

TEST(Ply, FacesOfTwoVerticesAreLeftOut) {
    const Scene scene = parse_ply(header("ascii", "4", "2") + ply_square + "7 2 0 1\n" + ply_face);
    EXPECT_EQ(scene.patches.size(), 2u);
    EXPECT_EQ(scene.warnings.entries().at(0).kind, "degenerate-face");
}

class PlyBadText : public testing::TestWithParam<BadText> {};
TEST_P(PlyBadText, IsNamedWithItsFault) {
    const std::string error = message_of([] { parse_ply(GetParam().text); });
    expect_in(error, "part.ply");
    expect_in(error, GetParam().expected);
}
const std::string binary_form = "binary_little_endian";
INSTANTIATE_TEST_SUITE_P(
    , PlyBadText,
    testing::Values(
        BadText{"Empty", "", "this is no PLY file"}, BadText{"Another", "solid a\n", "this is no PLY file"},
        BadText{"NoEnd", "ply\nformat ascii 1.0\n", "the header has no end"},
        BadText{"NoFormat", "ply\nend_header\n", "lacks a format"},
        BadText{"AnotherFormat", header("middle_endian"), "expected 'format ascii|"},
        BadText{"AnotherType", "ply\nelement a 1\nproperty quad x\n", "part.ply:3: PLY files have no type 'quad'"},
        BadText{"EarlyProperty", "ply\nproperty float x\n", "before the first element"},
        BadText{"FloatLength", "ply\nelement a 1\nproperty list float int x\n", "must be a whole number"},
        BadText{"NegativeCount", header("ascii", "-4") + ply_square + ply_face, "'-4' is no count"},
        BadText{"BillionVertices", header("ascii", "1000000000") + ply_square + ply_face,
                "too short for 1000000000 of 'vertex'"},
        BadText{"BinaryBillion", header(binary_form, "1000000000") + ply_square, "too short for 1000000000"},
        BadText{"Overflow", header(binary_form, "18446744073709551615") + ply_square, "too short"},
        BadText{"BillionFaces", header("ascii", "4", "1000000000") + ply_square + ply_face,
                "too short for 1000000000 of 'face'"},
        BadText{"NoY", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float z\nend_header\n0 0\n",
                "needs the properties x, y and z"},
        BadText{"RepeatedProperty", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty int x\n",
                "part.ply:5: property 'x' of the element 'vertex' is repeated"},
        BadText{"NoFaces", header("ascii", "4", "0") + ply_square, "the scene is empty"},
        BadText{"OutOfRange", header("ascii") + ply_square + "7 3 0 1 4\n",
                "part.ply:16: a face has vertex 4, but there are 4"},
        BadText{"NegativeIndex", header("ascii") + ply_square + "7 3 0 1 -1", "-1 is no number of a vertex"},
        BadText{"EndlessList", header("ascii") + ply_square + "7 1e21 0 1 2", "1e+21 is no length of a list"},
        BadText{"LongList", header("ascii") + ply_square + "7 255 0 1 2", "ends within a list of 255"},
        BadText{"NaN", header("ascii") + "nan 0 0\n2 0 0\n2 1 0\n0 1 0\n" + ply_face,
                "part.ply:12: expected a finite number, not 'nan'"},
        BadText{"Cut", header("ascii") + ply_square + "7 4 0 1", "ends within a list of 4"}),
    testing::PrintToStringParamName());

TEST(Ply, LimitOfPatchesIsNamed) {
    expect_in(message_of([] { parse_ply(header("ascii") + ply_square + ply_face, {.max_patches = 0}); }),
              "max_patches");
}

}  // namespace
}  // namespace interflect
