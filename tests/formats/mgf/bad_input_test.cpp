// Bad input gives an InputError that names file and line, without delay.
#include <gtest/gtest.h>

#include <chrono>

#include "interflect/core.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/load.h"
#include "tests/support/refusals.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

namespace fs = std::filesystem;
using namespace testing_support;

const std::string three_points = "v a =\n p 0 0 0\nv b =\n p 1 0 0\nv d =\n p 1 1 0\n";  // six lines

std::string message(const std::string& text, const ReadOptions& options = {}) {
    return message_of([&] { read_mgf_text(text, "bad.mgf", options); });
}

struct BadLine {
    const char* name;
    const char* line;      // the seventh, after the vertices; then all that a face needs to use it
    const char* expected;  // part of the message
};
void PrintTo(const BadLine& bad, std::ostream* out) { *out << bad.name; }

class MgfBadLine : public testing::TestWithParam<BadLine> {};

TEST_P(MgfBadLine, IsNamedWithItsFault) {
    const std::string error = message(three_points + GetParam().line + "\nf a b d\n");
    expect_in(error, "bad.mgf:7: ");
    expect_in(error, GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    , MgfBadLine,
    testing::Values(
        BadLine{"UndefinedVertex", "f a b missing", "vertex 'missing' is not defined"},
        BadLine{"TwoVertices", "f a b", "f vertex1 vertex2 vertex3"},

        BadLine{"EmptyHole", "fh - a b d", "three different vertices"},
        BadLine{"HoleOfTwo", "fh a b d - a b", "three different vertices"},
        BadLine{"UnknownLight", "light bulb a 1", "unknown light 'bulb'"},
        BadLine{"LightWithoutIntensity", "light point a", "light point vertex intensity"},
        BadLine{"NegativeLight", "light sky -1", "'-1' must not be"},
        BadLine{"LightTooBright", "light point a 2e10", "this light is too bright"},
        BadLine{"LightWithoutDirection", "light spot a 1 0 45", "needs a normal"},
        BadLine{"LightOfABadColour", "cct 10\nlight sky 5", "a colour temperature must be"},

        BadLine{"NotANumber", "p nan 0 0", "'nan' is not a finite number"},
        BadLine{"Infinity", "p 0 inf 0", "'inf' is not a finite number"},
        BadLine{"BeyondSinglePrecision", "p 0 0 1e39", "'1e39' is not a finite number"},
        BadLine{"Hexadecimal", "p 0 0 0x10", "'0x10' is not a finite number"}, BadLine{"CutPoint", "p 0 0", "p x y z"},
        BadLine{"CutNumber", "p 0 0 -", "'-' is not a finite number"},
        BadLine{"NegativeReflectance", "rd -.1", "'-.1' must not be negative"},
        BadLine{"NegativeEmission", "ed -1", "'-1' must not be negative"},
        BadLine{"NegativeSpecular", "rs -.1 0", "must not be negative"},
        BadLine{"Sides", "sides 3", "sides must be 1 or 2"},
        BadLine{"Chromaticity", "cxy .8 .3\nrd .5", "is no chromaticity"},

        BadLine{"ChromaticityBelow", "cxy .4 -.1\nrd .5", "is no chromaticity"},
        BadLine{"ColourOfALamp", "cct 500\ned 5", "at least 1000 K"},
        BadLine{"HugeEmission", "ed 1e30", "cannot be computed: expected at most 1e+10"},
        BadLine{"Spectrum", "cspec 780 380 1 1\nrd .5", "the shortest wavelength"},
        BadLine{"Temperature", "cct 500\nrd .5", "at least 1000 K"},
        BadLine{"MixOfUndefined", "cmix 1 red 1 blue\nrd .5", "colour 'red' is not defined"},
        BadLine{"MixOddly", "cmix 1 red 1 blue 1\nrd .5", "pairs"},
        BadLine{"Refraction", "ir 0 0", "index of refraction"},
        BadLine{"UndefinedMaterial", "m paint", "material 'paint' is not defined"},
        BadLine{"UndefinedTemplate", "m paint = paint", "material 'paint' is not defined"},
        BadLine{"NoEquals", "v a b", "expected '='"}, BadLine{"NoName", "v =", "is not defined"},
        BadLine{"NoImage", "texture ts", "expected 'texture rd|ed|ts image'"},
        BadLine{"DashName", "v - =", "cannot be a name"}, BadLine{"Sphere", "sph a 0", "radius of a sphere"},
        BadLine{"RingWithoutNormal", "ring a 0 1", "vertex 'a' needs a normal"},
        BadLine{"Torus", "torus a 0 1", "needs a normal"}, BadLine{"Cone", "cone a 1 b -1", "must not differ in sign"},
        BadLine{"Cylinder", "cyl a 1 a", "at one place"}, BadLine{"Prism", "prism a b d 0", "length of a prism"},
        BadLine{"UnknownTransform", "xf -q 1", "'-q' is no transform"},
        BadLine{"TransformByZero", "xf -s 0", "-s cannot scale by 0"},
        BadLine{"CloseWithoutOpen", "xf", "none was opened"},
        BadLine{"BillionCopies", "xf -a 1000000000 -t 1 0 0", "(max_patches)"},
        BadLine{"BillionCopiesTogether", "xf -a 10000 -t 1 0 0 -a 100000 -t 0 1 0", "(max_patches)"},
        BadLine{"MissingInclude", "i nowhere.mgf", "no such file"}),
    testing::PrintToStringParamName());

TEST(MgfBadInput, SpotLightWithoutACone) {
    expect_in(message(three_points + "v x =\n n 0 0 1\nlight spot x 1 50 45\nf a b d\n"),
              "bad.mgf:9: this light has angles of 50 and 45 degrees; expected 0 <= inner <= outer");
}

TEST(MgfBadInput, TransformThatOverflows) {
    expect_in(message(three_points + "xf -s 1e38 -s 1e38\nf a b d\nxf\n"), "bad.mgf:8: the transformed point");
    expect_in(message(three_points + "xf -i 1000000000 -s 2\n"), "bad.mgf:7: the transform is not finite");
}

TEST(MgfBadInput, NoUsableFaceIsLeft) {
    expect_in(message(""), "no usable face is left");
    expect_in(message(three_points), "no usable face is left");
    expect_in(message("v a =\nv b =\nv d =\nf a b d\n"), "no usable face is left");
    expect_in(message("some text that is no scene\nat all\n"), "no usable face is left");
}

TEST(MgfBadInput, WithoutAUsableFaceTheFirstLeftOutIsNamed) {
    expect_in(message(three_points + "f a b b\nf a a b\n"),
              "bad.mgf:7: no usable face is left: 2 are left out, and this is the first of them: face with fewer than "
              "three different vertices");
    expect_in(message(three_points + "v e =\n p 0 1 0\nf a d b e\n"), "bad.mgf:9: no usable face is left");
    expect_in(message(three_points + "v e =\n p 0 1 0\nf a d b e\n"), "outline crosses itself");
    expect_in(message(three_points + "f a b missing\n"), "'missing' is not defined");
    expect_in(message(three_points + "f a b b missing\n"), "'missing' is not defined");
}

TEST(MgfBadInput, AFaultCountsWhereItIsOnceAFaceUsesIt) {
    const std::string bad = three_points + "c bad =\n cct 5\nc mixed =\n cmix 1 bad 1 bad\n";
    const std::string uses = "m one =\n c mixed\n rd .5\nm two = one\nf a b d\n";
    expect_in(message(bad + uses), "bad.mgf:8: a colour temperature must be at least 1000 K");
    expect_in(message(bad + "m one =\n c mixed\n ed 5\nf a b d\n"), "bad.mgf:8: ");
    EXPECT_EQ(message(bad + "m one =\n c mixed\n ed 0\n rd 0\nf a b d\n"), "no error") << "a black one uses none";
    EXPECT_EQ(message(bad + "m one =\n c bad\n cxy .3 .3\n rd .5\nf a b d\n"), "no error") << "what is mended is good";
    expect_in(message(three_points + "m x =\n rd -1\nm y = x\n ed z\nf a b d\n"), "bad.mgf:8: '-1' must not be");
    expect_in(message(three_points + "m x =\n rd -1\n"), "bad.mgf:8: '-1' must not be");
    expect_in(message(three_points + "m x =\n rd -1\nsph a 1\n"), "bad.mgf:8: '-1' must not be");
}

// ---- Values beyond the numeric limits

std::string mgf_square(const std::string& size, const std::string& more = "") {
    return "m x =\n rd .5\nv a =\nv b =\n p " + size + " 0 0\nv d =\n p 0 " + size + " 0\n" + more + "f a b d\n";
}

// Fails without the limits, with areas of inf and 0.
TEST(MgfBadInput, FacesThatAreTooWideAndScenesThatAreTooSmall) {
    EXPECT_EQ(message(mgf_square("7e6")), "no error");
    expect_in(message(mgf_square("7.1e6")), "bad.mgf:8: this face is 1e+07 m wide; at most 1e+07 m can be computed");
    expect_in(message(mgf_square("1e14")), "bad.mgf:8: this face is 1.41e+14 m wide");
    expect_in(message(mgf_square("1e38")), "bad.mgf:8: the transformed point (1e+38, 0, 0) is farther than 1e+15 m");
    EXPECT_EQ(message(mgf_square("8e-7")), "no error");
    for (const char* const size : {"5e-7", "1e-12", "1e-38"})
        expect_in(message(mgf_square(size)), "m wide; at least 1e-06 m can be computed");
    EXPECT_EQ(message(mgf_square("1", "v e =\n p 1e-10 0 0\nv g =\n p 0 1e-10 0\nf a e g\n")), "no error") << "litter";
}

TEST(MgfBadInput, ExitanceThatCannotBeComputed) {
    for (const char* const exitance : {"0", "1.1e-9", "9.9e9"})
        EXPECT_EQ(message(mgf_square("1", "m x\n ed " + std::string(exitance) + "\n")), "no error") << exitance;
    for (const char* const exitance : {"1.1e10", "1e30", "1e38"})
        expect_in(message(mgf_square("1", "m x\n ed " + std::string(exitance) + "\n")), "bad.mgf:9: exitance (");
    for (const char* const exitance : {"1e-40", "9e-10"})
        expect_in(message(mgf_square("1", "m x\n ed " + std::string(exitance) + "\n")),
                  "bad.mgf: the scene emits only");
}

TEST(MgfBadInput, BinaryJunk) {
    std::string junk = "v a =\n p 0 0 0\n";
    junk += '\0';
    expect_in(message(junk), "bad.mgf:3: this is not a text file");
}

TEST(MgfBadInput, FileCutAtAnyPlaceIsReadOrRefused) {
    const std::string text = "m x =\n rd .5\n" + three_points + "o thing\nxf -t 0 0 1 -a 2 -t 0 0 3\nf a b d\nxf\no\n";
    for (std::size_t length = 0; length < text.size(); ++length) {
        const std::string error = message(text.substr(0, length));
        if (error != "no error") expect_in(error, "bad.mgf");
    }
    EXPECT_EQ(message(text), "no error");
}

// ---- Limits: refused before the time and memory are spent

TEST(MgfLimits, CopiesTimesContent) {
    // 1,000 copies are within the limit of 10,000 patches; with 256 patches each they exceed it.
    const std::string text = "v c =\nxf -a 1000 -t 3 0 0\nsph c 1\nxf\n";
    expect_in(message(text, {.max_patches = 10'000}),
              "bad.mgf:4: this would give more than 10000 patches (max_patches)");
    EXPECT_EQ(message(text, {.max_patches = 256'000}), "no error");
}

TEST(MgfLimits, Patches) {
    const std::string text = three_points + "f a b d\nf a b d\n";
    EXPECT_EQ(message(text, {.max_patches = 4}), "no error");
    expect_in(message(text, {.max_patches = 3}), "bad.mgf:8: this would give more than 3 patches");
    EXPECT_EQ(testing_support::refused_setting([&] { read_mgf_text(text, "bad.mgf", {.max_patches = 3}); }),
              "max_patches");
}

TEST(MgfLimits, NestedArraysOfNothingEnd) {
    std::string text = three_points;
    for (int i = 0; i < 4; ++i) text += "xf -a 70 -t 1 0 0\n";  // 24 million copies
    for (int i = 0; i < 4; ++i) text += "xf\n";
    expect_in(message(text + "f a b d\n", {.max_patches = 10'000}), "(max_patches)");
    std::string sequence;
    for (int i = 0; i < 1000; ++i) sequence += "xf -a 10000 -t 1 0 0\nxf\n";
    expect_in(message(sequence, {.max_patches = 10'000}), "(max_patches)");
}

TEST(MgfLimits, ABillionCopiesAreRefusedAtOnce) {
    const auto start = std::chrono::steady_clock::now();
    message("xf -a 1000000000 -t 1 0 0\n" + three_points + "f a b d\nxf\n");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST(MgfLimits, NestingOfTransformsAndObjects) {
    std::string transforms, objects;
    for (int i = 0; i < 11; ++i) {
        transforms += "xf -s 1\n";
        objects += "o x\n";
    }
    expect_in(message(transforms, {.max_nesting = 10}), "bad.mgf:11: transforms are nested more than 10 deep");
    expect_in(message(objects, {.max_nesting = 10}), "bad.mgf:11: objects are nested more than 10 deep");
}

TEST(MgfLimits, LinesFacesAndNames) {
    expect_in(message(three_points + "f a b \\\n d\n", {.max_line_length = 9}), "bad.mgf:7: a line of 11 characters");
    expect_in(message(three_points + "f a b d\n", {.max_face_vertices = 2}), "bad.mgf:7: a face of 3 vertices");
    expect_in(message("m longer =\n", {.max_name_length = 5}), "bad.mgf:1: a name of 6 characters");
    expect_in(message("o a23\no b23\no c23\no d23\no e23\no f23\n", {.max_name_length = 5}), "bad.mgf:6: ");
}

TEST(MgfLimits, OptionsThemselves) {
    EXPECT_THROW(read_mgf_text("", "x.mgf", {.curve_divisions = 0}), InputError);
    EXPECT_THROW(read_mgf_text("", "x.mgf", {.max_patches = 5'000'000'000}), InputError);
}

// ---- Files

TEST(MgfBadFiles, MissingFileAndFolder) {
    const TemporaryFolder folder;
    expect_in(message_of([&] { read_mgf(folder.path() / "none.mgf"); }), "none.mgf: no such file");
    expect_in(message_of([&] { read_mgf(folder.path()); }), "this is a folder");
}

TEST(MgfBadFiles, IncludeNamesTheLineThatAskedForIt) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a.mgf", "\n\ni b.mgf\n");
    expect_in(message_of([&] { read_mgf(file); }), "a.mgf:3: " + (folder.path() / "b.mgf").string());
}

TEST(MgfBadFiles, FaultInAnIncludedFileIsNamedThere) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a.mgf", "i b.mgf\n");
    folder.write("b.mgf", "\nrd x\n");
    expect_in(message_of([&] { read_mgf(file); }), "b.mgf:2: ... is not a finite number");
}

TEST(MgfBadFiles, IncludeOfItselfNamesTheChain) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a.mgf", "i sub/../b.mgf\n");
    fs::create_directory(folder.path() / "sub");
    folder.write("b.mgf", "# comment\ni a.mgf\n");
    const std::string error = message_of([&] { read_mgf(file); });
    expect_in(error, "b.mgf:2: a file includes itself: ");
    expect_in(error, "a.mgf -> ");
}

TEST(MgfBadFiles, IncludesThatNestTooDeep) {
    const TemporaryFolder folder;
    for (int i = 0; i < 4; ++i)
        folder.write("f" + std::to_string(i) + ".mgf", "i f" + std::to_string(i + 1) + ".mgf\n");
    expect_in(message_of([&] { read_mgf(folder.path() / "f0.mgf", {.max_include_depth = 3}); }), "more than 3 deep");
}

TEST(MgfBadFiles, IncludedFileCannotCloseWhatItDidNotOpen) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("a.mgf", "xf -s 2\ni b.mgf\nxf\n");
    folder.write("b.mgf", "xf\n");
    expect_in(message_of([&] { read_mgf(file); }), "b.mgf:1: this closes a transform");
}

TEST(MgfBadFiles, FilesThatIncludeEachOtherManyTimesEnd) {
    // 10 files that include the next ten times each: 10^10 lines without a limit.
    const TemporaryFolder folder;
    for (int i = 0; i < 10; ++i) {
        std::string text;
        for (int k = 0; k < 10; ++k) text += "i f" + std::to_string(i + 1) + ".mgf\n";
        folder.write("f" + std::to_string(i) + ".mgf", text);
    }
    folder.write("f10.mgf", "rd .5\n");
    expect_in(message_of([&] { read_mgf(folder.path() / "f0.mgf", {.max_patches = 1000}); }), "(max_patches)");
}

// Fails without the limit by generated patches: 50 million patches would allow for 10^9 words.
TEST(MgfBadFiles, IncludesThatMakeNothingEndSoon) {
    RELEASE_ONLY();
    const TemporaryFolder folder;
    for (int i = 0; i < 9; ++i) {
        std::string text;
        for (int k = 0; k < 40; ++k) text += "i f" + std::to_string(i + 1) + ".mgf\n";
        folder.write("f" + std::to_string(i) + ".mgf", text);
    }
    folder.write("f9.mgf", "# nothing\n");
    const auto start = std::chrono::steady_clock::now();
    const std::string error = message_of([&] { read_mgf(folder.path() / "f0.mgf"); });
    expect_in(error, "mgf:");
    expect_in(error, "from which only 0 patches were made");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));  // asan takes longer
}

TEST(MgfLimits, CopiesOfNothingEndSoon) {
    RELEASE_ONLY();
    expect_in(message("xf -a 40000000 -t 1 0 0\nxf\n"), "bad.mgf:2: arrays and includes repeat 50 million words");
}

TEST(MgfLimits, FacesLeftOutCountAsPatches) {
    const std::string spheres = "v c =\n p 1 1 1\nsph c 1e-9\n";  // of 128 faces, all lost to rounding
    expect_in(message(three_points + "f a b d\n" + spheres, {.max_patches = 100}), "(max_patches)");
    expect_in(message(three_points + "f a b d\n" + spheres + "sph c 1e-9\n", {.max_patches = 200}), "(max_patches)");
    EXPECT_EQ(message(three_points + "f a b d\n" + spheres, {.max_patches = 200}), "no error");
}

TEST(LoadScene, UnknownExtensionListsTheKnownOnes) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("scene.xyz", "");
    expect_in(message_of([&] { load_scene(file); }), "'.xyz'; known: .mgf");
    expect_in(message_of([&] { load_scene(folder.path()); }), "this is a folder");
}

}  // namespace
}  // namespace interflect
