#include "interflect/base/files/escapes.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace interflect {

using namespace detail;
namespace {

TEST(Escapes, LeaveValidTextAsItIs) {
    for (const std::string text : {"", "the office.mgf", "wände", "C:\\scenes\\x", "\\", "\\x", "\\x4", "\\xg0",
                                   "\\xAB", "日本語", "😀", "\u00a0", "שלום", "\u200d\u2029\u2065"})
        EXPECT_EQ(escaped(text), text);
}

TEST(Escapes, ReplaceControlCharactersAndWhatIsNotUtf8) {
    const std::pair<std::string, std::string> cases[] = {
        {"a\x1b[31mb", "a\\x1b[31mb"},
        {std::string("\0\n\t\x7f", 4), "\\x00\\x0a\\x09\\x7f"},
        {"\xc2\x9b", "\\xc2\\x9b"},                           // U+009B, which some terminals take for ESC [
        {"b\xfcro", "b\\xfcro"},                              // Latin-1
        {"\xc0\xaf", "\\xc0\\xaf"},                           // overlong
        {"\xed\xa0\x80", "\\xed\\xa0\\x80"},                  // a surrogate
        {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},         // beyond U+10FFFF
        {"\xe6\x97", "\\xe6\\x97"},                           // cut off
        {"lamp\u202egpj.exe", "lamp\\xe2\\x80\\xaegpj.exe"},  // right-to-left override
        {"\u061c\u200e\u200f", "\\xd8\\x9c\\xe2\\x80\\x8e\\xe2\\x80\\x8f"},
        {"\u2066\u2069", "\\xe2\\x81\\xa6\\xe2\\x81\\xa9"},
        {"\\x41", "\\x5cx41"},
        {"\\\\x41", "\\\\x5cx41"}};
    for (const auto& [text, expected] : cases) EXPECT_EQ(escaped(text), expected);
}

TEST(Escapes, LoseNothing) {
    const std::string alphabet = "\\x5cf0\x1b\n\xc3\xa4\xff\xe2\x82";  // parts of escapes, and characters to escape
    std::mt19937 random(1);
    for (int trial = 0; trial < 20'000; ++trial) {
        std::string text(random() % 12, '\0');
        for (char& c : text) c = alphabet[random() % alphabet.size()];
        EXPECT_EQ(unescaped(escaped(text)), text) << escaped(text);
    }
}

}  // namespace
}  // namespace interflect
