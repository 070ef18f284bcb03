#include "interflect/formats/text/line_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace interflect {

using namespace detail;
namespace {

using Lines = std::vector<std::pair<std::int64_t, std::vector<std::string>>>;

Lines all_lines(std::string_view text) {
    Lines lines;
    for (LineReader reader(text); reader.next();)
        lines.emplace_back(reader.line(), std::vector<std::string>(reader.words().begin(), reader.words().end()));
    return lines;
}

TEST(LineReader, SplitsAtWhiteSpaceAndSkipsEmptyLines) {
    EXPECT_EQ(all_lines("a  b\n\n\t c\td \n"), (Lines{{1, {"a", "b"}}, {3, {"c", "d"}}}));
}

TEST(LineReader, LastLineNeedsNoEnd) { EXPECT_EQ(all_lines("a\nb c"), (Lines{{1, {"a"}}, {2, {"b", "c"}}})); }

TEST(LineReader, BackslashAtTheEndJoinsLines) {
    EXPECT_EQ(all_lines("a b \\\n c\\\n\td\ne"), (Lines{{1, {"a", "b", "c", "d"}}, {4, {"e"}}}));
}

TEST(LineReader, BackslashElsewhereIsPartOfAWord) {
    EXPECT_EQ(all_lines("a\\b \\ c\nd\\"), (Lines{{1, {"a\\b", "\\", "c"}}, {2, {"d\\"}}}));
}

TEST(LineReader, LineEndsOfWindows) {
    EXPECT_EQ(all_lines("a\r\nb \\\r\n c\r\n"), (Lines{{1, {"a"}}, {2, {"b", "c"}}}));
}

TEST(LineReader, NothingGivesNoLine) {
    EXPECT_TRUE(all_lines("").empty());
    EXPECT_TRUE(all_lines("\n \n\\\n").empty());
}

TEST(LineReader, SeekGoesBackWithTheLineNumber) {
    LineReader reader("a\nb\nc");
    reader.next();
    const LineReader::Position after_a = reader.position();
    reader.next();
    reader.next();
    reader.seek(after_a);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.words()[0], "b");
    EXPECT_EQ(reader.line(), 2);
}

}  // namespace
}  // namespace interflect
