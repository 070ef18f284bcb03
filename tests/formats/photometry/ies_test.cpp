// IES LM-63 files, apart from the angles: versions, factors, openings, TILT, separators; tolerated faults with a
// warning, and errors with a line.
//
// Seen to fail when the multiplier or the ballast factor is omitted, when feet are metres, when width and length are
// exchanged, when the last factor counts in files of 2019.
#include "interflect/formats/photometry/ies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "interflect/core.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/photometry_files.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using Shape = LuminousOpening::Shape;
using testing::HasSubstr;

struct ParsedIes {
    PhotometricWeb web;
    Warnings warnings;
};
ParsedIes parse_ies(const std::string& text) {
    ParsedIes result;
    result.web = read_ies_text(text, "lamp.ies", {}, result.warnings);
    return result;
}
PhotometricWeb web_of(const IesText& text) { return parse_ies(text.str()).web; }

TEST(Ies, FactorsMultiplyIntensities) {
    EXPECT_FLOAT_EQ(web_of({.multiplier = 2.5}).peak(), 250);
    EXPECT_FLOAT_EQ(web_of({.ballast_factor = 0.9}).peak(), 90);
    const auto with_version = [](const std::string& version) {
        return web_of({.version = version, .last_factor = 0.5}).peak();
    };
    EXPECT_FLOAT_EQ(with_version(""), 50);
    EXPECT_FLOAT_EQ(with_version("IESNA91\n"), 50);
    EXPECT_FLOAT_EQ(with_version("IESNA:LM-63-1995\n"), 50);
    EXPECT_FLOAT_EQ(with_version("IESNA:LM-63-2002\n"), 100);
    EXPECT_FLOAT_EQ(with_version("IES:LM-63-2019\n"), 100);
}

TEST(Ies, LampsHaveAFluxUnlessPhotometryIsAbsolute) {
    EXPECT_EQ(web_of({.lamps = 2, .lumens = 2900}).lamp_lumens, 5800);
    EXPECT_EQ(web_of({.lamps = 2, .lumens = -1}).lamp_lumens, 0);
    EXPECT_FLOAT_EQ(web_of({.lamps = 2, .lumens = -1}).peak(), 100);
}

struct OpeningCase {
    std::string sizes;  // width, length, height
    Shape shape;
    V3f size;  // along the C0 plane, across, up
    int axis = 2;
};
void PrintTo(const OpeningCase& opening, std::ostream* out) { *out << opening.sizes; }
class IesOpening : public testing::TestWithParam<OpeningCase> {};
INSTANTIATE_TEST_SUITE_P(
    All, IesOpening,
    testing::Values(
        OpeningCase{"0 0 0", Shape::box, {0, 0, 0}}, OpeningCase{"2 3 0", Shape::box, {3, 2, 0}},
        OpeningCase{"2 3 .5", Shape::box, {3, 2, 0.5f}}, OpeningCase{"-2 -2 0", Shape::cylinder, {2, 2, 0}},
        OpeningCase{"-2 0 0", Shape::cylinder, {2, 2, 0}}, OpeningCase{"-2 -3 1", Shape::cylinder, {3, 2, 1}},
        OpeningCase{"-2 0 1", Shape::cylinder, {2, 2, 1}}, OpeningCase{"-2 3 0", Shape::cylinder, {3, 2, 0}},
        OpeningCase{"-1 -1 -1", Shape::ellipsoid, {1, 1, 1}}, OpeningCase{"-1 2 -1", Shape::cylinder, {2, 1, 1}, 0},
        OpeningCase{"0 2 -1", Shape::cylinder, {2, 1, 1}, 0}, OpeningCase{"2 -1 -1", Shape::cylinder, {1, 2, 1}, 1},
        OpeningCase{"2 0 -1", Shape::cylinder, {1, 2, 1}, 1}, OpeningCase{"-1 0 -1", Shape::ellipsoid, {1, 1, 1}},
        OpeningCase{"0 -1 -1", Shape::ellipsoid, {1, 1, 1}}),
    printed_name);

TEST_P(IesOpening, HasItsShapeAndSize) {
    const LuminousOpening opening = web_of({.opening = GetParam().sizes}).opening;
    EXPECT_EQ(opening.shape, GetParam().shape);
    EXPECT_EQ(opening.size, GetParam().size);
    EXPECT_EQ(opening.axis, GetParam().axis);
    EXPECT_LT((web_of({.unit = 1, .opening = GetParam().sizes}).opening.size - 0.3048f * GetParam().size).length(),
              1e-6f);
}

/// A sphere was a disk of no area, and an ellipsoid a cylinder.
TEST(Ies, RoundHeightsWereEllipsoidsUntil1995) {
    for (const char* version : {"IESNA:LM-63-1995\n", "IESNA91\n"}) {
        const LuminousOpening sphere = web_of({.version = version, .opening = "-2 0 -2"}).opening;
        EXPECT_EQ(sphere.shape, Shape::ellipsoid);
        EXPECT_EQ(sphere.size, V3f(2, 2, 2));
        const LuminousOpening ellipsoid = web_of({.version = version, .opening = "-1 3 -2"}).opening;
        EXPECT_EQ(ellipsoid.shape, Shape::ellipsoid);
        EXPECT_EQ(ellipsoid.size, V3f(3, 1, 2));
        EXPECT_EQ(web_of({.version = version, .opening = "-2 0 1"}).opening.shape, Shape::cylinder);
        EXPECT_EQ(web_of({.version = version, .opening = "0 2 -1"}).opening.axis, 0);
    }
}

TEST(Ies, UnlikelyUnitsAreWarnedOf) {
    const auto kinds = [](int unit, const char* opening) {
        std::vector<std::string> found;
        const ParsedIes lamp = parse_ies(IesText{.unit = unit, .opening = opening}.str());
        for (const Warnings::Entry& warning : lamp.warnings.entries()) found.push_back(warning.kind);
        return found;
    };
    const std::vector<std::string> none, unit{"ies-unit"};
    EXPECT_EQ(kinds(1, "0.6 0.6 0"), unit);
    EXPECT_EQ(kinds(1, "0.297 1.197 0"), unit);
    EXPECT_EQ(kinds(2, "600 600 0"), unit);
    EXPECT_EQ(kinds(2, "-600 0 0"), unit);
    EXPECT_EQ(kinds(2, "0.6 0.6 0"), none);
    EXPECT_EQ(kinds(1, "2 4 0"), none);
    EXPECT_EQ(kinds(1, "0.3 0.3 0"), none);
    EXPECT_EQ(kinds(1, "-0.6 -0.6 0"), none);
}

TEST(Ies, TwoPlanesAreEnoughOfAHalf) {
    for (const std::vector<double>& horizontal : {std::vector<double>{0, 180}, {90, 270}}) {
        const ParsedIes found = parse_ies(IesText{.horizontal = horizontal}.str());
        EXPECT_TRUE(found.warnings.entries().empty());
        EXPECT_EQ(found.web.azimuth.size(), 3u);
        EXPECT_FLOAT_EQ(found.web.intensity({-0.3f, 0.7f, -1}), 100);
    }
}

TEST(Ies, LineBreaksAndSeparatorsAreFree) {
    const auto expect_same = [](const std::string& text) {
        const ParsedIes found = parse_ies(text);
        EXPECT_EQ(found.web.intensities, std::vector<float>({100, 100, 100, 100}));
        EXPECT_TRUE(found.warnings.entries().empty());
    };
    for (const char* line_break : {"\n", "\r\n", "\r"})
        expect_same(IesText{.version = std::string("IESNA:LM-63-1995") + line_break,
                            .tilt = std::string("TILT=NONE") + line_break,
                            .line_break = line_break}
                        .str());
    expect_same(IesText{.line_break = " "}.str());
    expect_same(IesText{.separator = ", "}.str());
    expect_same(IesText{.separator = "\n"}.str());
    expect_same(IesText{.tilt = " tilt = none\n"}.str());
}

TEST(Ies, MarksOfEditorsAndOfMsDosAreNoText) {
    const TemporaryFolder folder;
    Warnings warnings;
    const auto path = folder.write("lamp.ies", "\xef\xbb\xbf" + IesText().str() + "\x1a");
    EXPECT_FLOAT_EQ(read_ies(path, {}, warnings).peak(), 100);
    EXPECT_TRUE(warnings.entries().empty());
}

const std::string tilt_data = "1 3\n0 45 90\n0.9 1 0.8\n";

TEST(Ies, TiltIsThatOfTheMeasurement) {
    const ParsedIes included = parse_ies(IesText{.tilt = "TILT=INCLUDE\n" + tilt_data}.str());
    EXPECT_FLOAT_EQ(included.web.peak(), 90);
    ASSERT_EQ(included.warnings.entries().size(), 1u);
    EXPECT_EQ(included.warnings.entries()[0].kind, "ies-tilt");

    const TemporaryFolder folder;
    folder.write("lamp.tlt", tilt_data);
    Warnings warnings;
    EXPECT_FLOAT_EQ(read_ies(folder.write("a.ies", IesText{.tilt = "TILT=lamp.tlt\n"}.str()), {}, warnings).peak(), 90);
    EXPECT_EQ(warnings.entries().size(), 1u);
    const auto without = folder.write("b.ies", IesText{.tilt = "TILT=other.tlt\n"}.str());
    try {
        read_ies(without, {}, warnings);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("b.ies:3: the TILT file"));
    }
}

struct Oddity {
    std::string kind, text;
};
void PrintTo(const Oddity& oddity, std::ostream* out) { *out << oddity.kind; }
class IesOddity : public testing::TestWithParam<Oddity> {};
INSTANTIATE_TEST_SUITE_P(
    All, IesOddity,
    testing::Values(Oddity{"ies-version", IesText{.version = "IESNA95\n"}.str()},
                    Oddity{"ies-lumens", IesText{.lumens = 0}.str()},
                    Oddity{"ies-angles", IesText{.vertical = {0, 80}}.str()},
                    Oddity{"ies-angles", IesText{.type = 2, .vertical = {-40, 40}, .horizontal = {-40, 40}}.str()},
                    Oddity{"ies-angles", IesText{.horizontal = {0, 90, 180, 270}}.str()},
                    Oddity{"ies-negative", IesText{.intensity = [](double v, double) { return v > 0 ? -1 : 5; }}.str()},
                    Oddity{"ies-opening", IesText{.opening = "1 1 -1"}.str()},
                    Oddity{"ies-reserved", IesText{.last_factor = 0.5}.str()},
                    Oddity{"ies-trailing", IesText().str() + "1 2 3"}),
    [](const auto& test) { return printed_name(test) + '_' + std::to_string(test.index); });

TEST_P(IesOddity, IsToleratedWithOneWarning) {
    const ParsedIes found = parse_ies(GetParam().text);
    ASSERT_EQ(found.warnings.entries().size(), 1u);
    EXPECT_EQ(found.warnings.entries()[0].kind, GetParam().kind);
    EXPECT_THAT(found.warnings.entries()[0].where, HasSubstr("lamp.ies:"));
}

std::vector<MalformedText> malformed_ies() {
    const std::string good = IesText().str();
    const auto cut = [&](std::size_t from_end) { return good.substr(0, good.size() - from_end); };
    const auto numbers = [](const std::string& text) { return "IESNA91\nTILT=NONE\n" + text; };
    return {
        {"Empty", "", "lamp.ies:1: expected a line that begins with TILT="},
        {"NoTilt", "IESNA91\n1 2 3\n", ":2: expected a line that begins with TILT="},
        {"TiltWithoutValue", "IESNA91\nTILT=\n", ":2: expected TILT=NONE"},
        {"TiltWithoutEquals", "IESNA91\nTILT NONE\n1 1000\n", "expected a line that begins with TILT="},
        {"TiltFileMissing", IesText{.tilt = "TILT=no.tlt\n"}.str(), ":3: the TILT file no.tlt: no such file"},
        {"TiltGeometry", IesText{.tilt = "TILT=INCLUDE\n4 1 0 1\n"}.str(), ":4: the lamp's geometry in TILT data is 4"},
        {"TiltCount", IesText{.tilt = "TILT=INCLUDE\n1 0\n"}.str(), ":4: the number of TILT angles is 0"},
        {"TiltOrder", IesText{.tilt = "TILT=INCLUDE\n1 2\n90 0\n1 1\n"}.str(), ":6: TILT angles must ascend"},
        {"TiltNegative", IesText{.tilt = "TILT=INCLUDE\n1 1 0 -1\n"}.str(), ":4: a TILT factor must not be negative"},
        {"TiltHuge", IesText{.tilt = "TILT=INCLUDE\n1 1e9\n"}.str(), "expected a whole number from 1 to 1000000"},
        {"NothingAfterTilt", numbers(""), ":2: the file ends before the number of lamps"},
        {"Words", numbers("1 many 1"), ":3: expected the lumens of a lamp, found 'many'"},
        {"Hexadecimal", numbers("1 0x10 1"), "found '0x10'"},
        {"NotANumber", numbers("1 nan 1"), "found 'nan'"},
        {"Overflow", numbers("1 1e99 1"), "found '1e99'"},
        {"NoLamps", IesText{.lamps = 0}.str(), ":4: the number of lamps is 0; expected a number above 0"},
        {"Multiplier", IesText{.multiplier = 0}.str(), "the multiplier is 0"},
        {"NegativeMultiplier", IesText{.multiplier = -1}.str(), "the multiplier is -1"},
        {"OneVerticalAngle", numbers("1 1 1 1 1 1 2 0 0 0 1 1 1 0 0 5"), ":3: the number of vertical angles is 1"},
        {"FractionOfAnAngle", numbers("1 1 1 2.5 1 1 2"), "the number of vertical angles is 2.5"},
        {"NegativeCount", numbers("1 1 1 2 -1 1 2"), "the number of horizontal angles is -1"},
        {"TooMany", numbers("1 1 1 100000 100000 1 2"), "expected a whole number from 1 to 10"},
        {"Type", IesText{.type = 4}.str(), "the photometric type is 4; expected a whole number from 1 to 3"},
        {"Unit", IesText{.unit = 3}.str(), "the unit of length is 3"},
        {"OpeningOfWords", IesText{.opening = "wide 1 1"}.str(),
         "expected a size of the luminous opening, found 'wide'"},
        {"HugeOpening", IesText{.opening = "1e30 1 1"}.str(), "this luminaire has a luminous opening of"},
        {"BallastFactor", IesText{.ballast_factor = 0}.str(), ":5: the ballast factor is 0"},
        {"LastFactor", IesText{.last_factor = -2}.str(), "the ballast-lamp photometric factor is -2"},
        {"VerticalOrder", IesText{.vertical = {0, 50, 40}}.str(), ":6: vertical angles must ascend, but 40 follows 50"},
        {"VerticalTwice", IesText{.vertical = {0, 50, 50}}.str(), "but 50 follows 50"},
        {"VerticalRange", IesText{.vertical = {0, 190}}.str(), "a vertical angle of 190 degrees; expected 0 to 180"},
        {"VerticalOfTypeA", IesText{.type = 3, .vertical = {-100, 0}}.str(), "expected -90 to 90"},
        {"HorizontalOrder", IesText{.horizontal = {0, 90, 80}}.str(), ":7: horizontal angles must ascend"},
        {"HorizontalRange", IesText{.horizontal = {0, 400}}.str(), "a horizontal angle of 400 degrees"},
        {"HorizontalOfTypeB", IesText{.type = 2, .horizontal = {0, 100}}.str(), "expected -90 to 90"},
        {"HorizontalEnd", IesText{.horizontal = {0, 50, 100}}.str(), ":7: horizontal angles from 0 to 100; expected 0"},
        {"HorizontalStart", IesText{.horizontal = {10, 55, 100}}.str(), "horizontal angles from 10 to 100"},
        {"OnePlaneOfTypeB", IesText{.type = 2}.str(), "a single horizontal angle"},
        {"IntensityMissing", cut(6), "the file ends before an intensity"},
        {"IntensityOfLetters", cut(2) + "x", ":8: expected an intensity, found '100x'"},
        {"Dark", IesText{.intensity = [](double, double) { return 0; }}.str(), "this luminaire emits nothing"},
        {"TooBright", IesText{.multiplier = 1e30}.str(), "this luminaire has an intensity of"},
        {"Binary", good + std::string(1, '\0'), "this is not a text file"},
    };
}

class MalformedIes : public testing::TestWithParam<MalformedText> {};
INSTANTIATE_TEST_SUITE_P(All, MalformedIes, testing::ValuesIn(malformed_ies()),
                         [](const auto& test) { return test.param.name; });

TEST_P(MalformedIes, IsAnErrorThatNamesTheLine) {
    expect_error([](const std::string& text) { parse_ies(text); }, GetParam(), "lamp.ies");
}

TEST(Ies, HugeFilesAreRefused) {
    const TemporaryFolder folder;
    Warnings warnings;
    const auto path = folder.write("lamp.ies", IesText().str());
    ReadOptions options;
    options.max_photometric_bytes = 50;
    EXPECT_THROW(read_ies(path, options, warnings), InputError);
    options = {};
    options.max_photometric_values = 1;
    EXPECT_THROW(read_ies(path, options, warnings), InputError);
}

}  // namespace
}  // namespace interflect
