// EULUMDAT files, apart from the angles: tolerated faults with a warning, and errors with a line.
//
// Seen to fail when the opening's length runs along C0, and when half planes are confused.
#include "interflect/formats/photometry/ldt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "interflect/core.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/photometry_files.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::HasSubstr;

struct ParsedLdt {
    PhotometricWeb web;
    Warnings warnings;
};
ParsedLdt parse_ldt(const std::string& text) {
    ParsedLdt result;
    result.web = read_ldt_text(text, "lamp.ldt", {}, result.warnings);
    return result;
}

TEST(Ldt, IntensitiesAreForAThousandLumens) {
    EXPECT_FLOAT_EQ(parse_ldt(LdtText{.lumens = 3500}.str()).web.peak(), 350);
    EXPECT_FLOAT_EQ(parse_ldt(LdtText{.conversion = 1.2, .lumens = 3500}.str()).web.peak(), 420);
    EXPECT_EQ(parse_ldt(LdtText{.lumens = 3500}.str()).web.lamp_lumens, 3500);
    const PhotometricWeb absolute = parse_ldt(LdtText{.lumens = 3500, .lamps = -1}.str()).web;
    EXPECT_EQ(absolute.lamp_lumens, 0);
    EXPECT_FLOAT_EQ(absolute.peak(), 350);
}

TEST(Ldt, OpeningIsLongAlongC90) {
    const LuminousOpening box = parse_ldt(LdtText{.length = 1200, .width = 300}.str()).web.opening;
    EXPECT_EQ(box.shape, LuminousOpening::Shape::box);
    EXPECT_LT((box.size - V3f(0.3f, 1.2f, 0)).length(), 1e-6f);
    const LuminousOpening disk = parse_ldt(LdtText{.length = 200}.str()).web.opening;
    EXPECT_EQ(disk.shape, LuminousOpening::Shape::cylinder);
    EXPECT_LT((disk.size - V3f(0.2f, 0.2f, 0)).length(), 1e-6f);
}

TEST(Ldt, LineBreaksAreFree) {
    for (const char* line_break : {"\n", "\r\n", "\r"}) {
        const ParsedLdt found = parse_ldt(LdtText{.line_break = line_break}.str());
        EXPECT_FLOAT_EQ(found.web.peak(), 100);
        EXPECT_TRUE(found.warnings.entries().empty());
    }
}

struct LdtDeviation {
    std::string kind, text;
};
void PrintTo(const LdtDeviation& oddity, std::ostream* out) { *out << oddity.kind; }

/// Counts lines from 1.
std::string with_line(const LdtText& ldt, int n, const std::string& line) {
    std::string text = ldt.str();
    std::size_t begin = 0;
    for (int i = 1; i < n; ++i) begin = text.find("\r\n", begin) + 2;
    return text.replace(begin, text.find("\r\n", begin) - begin, line);
}

class LdtOddity : public testing::TestWithParam<LdtDeviation> {};
INSTANTIATE_TEST_SUITE_P(
    All, LdtOddity,
    testing::Values(
        LdtDeviation{"ldt-decimal-comma", with_line({}, 24, "1,5")}, LdtDeviation{"ldt-empty", with_line({}, 18, "")},
        LdtDeviation{"ldt-comment", with_line({}, 29, "1000 lm")},
        LdtDeviation{"ldt-comment", with_line({}, 44, "0 degrees")},
        LdtDeviation{"ldt-lamps", LdtText{.lamp_sets = 3}.str()}, LdtDeviation{"ldt-tilt", LdtText{.tilt = 15}.str()},
        LdtDeviation{"ldt-angles", LdtText{.gamma = {0, 80}}.str()},
        LdtDeviation{"ldt-negative", LdtText{.intensity = [](double g, double) { return g > 0 ? -1 : 5; }}.str()},
        LdtDeviation{"ldt-trailing", LdtText().str() + "1\r\n2"}),
    [](const auto& test) { return printed_name(test) + '_' + std::to_string(test.index); });

TEST_P(LdtOddity, IsToleratedWithOneWarning) {
    const ParsedLdt found = parse_ldt(GetParam().text);
    ASSERT_EQ(found.warnings.entries().size(), 1u);
    EXPECT_EQ(found.warnings.entries()[0].kind, GetParam().kind);
}

/// Each was refused, and empty direct ratios were read as angles.
TEST(Ldt, EmptyLinesHaveTheUsualValues) {
    const LdtText text{.length = 1200, .width = 300};
    const PhotometricWeb usual = parse_ldt(text.str()).web;
    for (const int line : {18, 19, 20, 21, 24, 25, 27, 33, 37, 42}) {
        const PhotometricWeb web = parse_ldt(with_line(text, line, "")).web;
        EXPECT_EQ(web.intensities, usual.intensities) << line;
        EXPECT_EQ(web.lamp_lumens, usual.lamp_lumens) << line;
        EXPECT_EQ(web.opening.size, usual.opening.size) << line;
        EXPECT_EQ(web.polar, usual.polar) << line;
    }
    EXPECT_TRUE(parse_ldt(with_line(text, 16, "")).web.opening.size.y == 0);
}

std::vector<MalformedText> malformed_ldt() {
    const std::string good = LdtText().str();
    const std::vector<double> four{0, 90, 180, 270};
    return {
        {"Empty", "", "lamp.ldt:1: the file ends"},
        {"OneLine", "a maker", ":1: the file ends"},
        {"SymmetryOfLetters", with_line({}, 3, "x"), ":3: expected the symmetry, found 'x'"},
        {"Symmetry", with_line({}, 3, "5"), ":3: the symmetry is 5; expected a whole number from 0 to 4"},
        {"NoPlanes", with_line({}, 4, "0"), ":4: the number of C planes is 0"},
        {"HalfAPlane", with_line({}, 4, "1.5"), ":4: the number of C planes is 1.5"},
        {"TooManyPlanes", with_line({}, 4, "1e9"), ":4: the number of C planes is 1000000000"},
        {"OneIntensity", with_line({}, 6, "1"), ":6: the number of intensities in a C plane is 1"},
        {"TooManyIntensities", with_line({}, 6, "2000000"), ":6: the number of intensities in a C plane is 2000000"},
        {"Length", with_line({}, 16, "long"), ":16: expected the length of the luminous area, found 'long'"},
        {"EmptyFlux", with_line({}, 29, ""), ":29: expected the flux of the lamps, found ''"},
        {"Thousands", with_line({}, 29, "1 000"), ":29: expected the flux of the lamps, found '1 000'"},
        {"NegativeLength", with_line({}, 16, "-5"), "the luminous area has a negative size"},
        {"HugeLength", with_line({}, 16, "1e30"), "this luminaire has a luminous opening"},
        {"Height", with_line({}, 19, "?"), ":19: expected the height of the luminous area"},
        {"Conversion", with_line({}, 24, "0"), ":24: the conversion factor is 0"},
        {"Tilt", with_line({}, 25, "steep"), ":25: expected the tilt"},
        {"NoLamps", with_line({}, 26, "0"), ":26: the number of sets of lamps is 0"},
        {"ManyLamps", with_line({}, 26, "1000"), ":26: the number of sets of lamps is 1000"},
        {"LampNumber", with_line({}, 27, "two"), ":27: expected the number of lamps, found 'two'"},
        {"DarkLamp", with_line({}, 29, "0"), ":29: the flux of the lamps is 0 lm"},
        {"LampOfWords", with_line({}, 29, "bright"), ":29: expected the flux of the lamps"},
        {"PlaneAngle", with_line({}, 43, "400"), ":43: a C angle of 400 degrees; expected 0 to 360"},
        {"NegativeGamma", with_line({}, 44, "-1"), ":44: a gamma angle of -1 degrees"},
        {"GammaOrder", with_line({}, 45, "0"), ":45: gamma angles must ascend, but 0 follows 0"},
        {"GammaBeyond", with_line({}, 45, "190"), "a gamma angle of 190 degrees; expected 0 to 180"},
        {"PlanesThatDoNotAscend", LdtText{.c = {0, 90, 80}}.str(), "C angles must ascend, but 80 follows 90"},
        {"HalfOfThreePlanes", LdtText{.symmetry = 2, .c = {0, 120, 240}}.str(),
         "3 C planes do not have the symmetry 2"},
        {"QuarterOfSix", LdtText{.symmetry = 4, .c = range(0, 300, 60)}.str(), "6 C planes do not have the symmetry 4"},
        {"UnevenHalf", LdtText{.symmetry = 2, .c = {0, 50, 100, 270}}.str(), "C planes from 0 to 100 degrees"},
        {"UnevenQuarter", LdtText{.symmetry = 4, .c = {0, 80, 180, 270}}.str(), "C planes from 0 to 80 degrees"},
        {"ShiftedHalf", LdtText{.symmetry = 3, .c = {45, 135, 225, 315}}.str(), "C planes from 315 to 495 degrees"},
        {"TooFewIntensities", good.substr(0, good.size() - 5), "the file ends before an intensity"},
        {"IntensityOfLetters", good.substr(0, good.size() - 2) + "cd", ":47: expected an intensity, found '100cd'"},
        {"Dark", LdtText{.intensity = [](double, double) { return 0; }}.str(), "this luminaire emits nothing"},
        {"TooBright", LdtText{.conversion = 1e20}.str(), "this luminaire has an intensity of"},
        {"Binary", good + std::string(1, '\x01'), "this is not a text file"},
    };
}

class MalformedLdt : public testing::TestWithParam<MalformedText> {};
INSTANTIATE_TEST_SUITE_P(All, MalformedLdt, testing::ValuesIn(malformed_ldt()),
                         [](const auto& test) { return test.param.name; });

TEST_P(MalformedLdt, IsAnErrorThatNamesTheLine) {
    expect_error([](const std::string& text) { parse_ldt(text); }, GetParam(), "lamp.ldt");
}

}  // namespace
}  // namespace interflect
