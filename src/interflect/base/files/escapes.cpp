#include "interflect/base/files/escapes.h"

#include <algorithm>
#include <cstdint>

namespace interflect::detail {

namespace {

constexpr std::string_view hex_digits = "0123456789abcdef";
constexpr std::size_t escape_length = 4;  // \xNN

/// UTF-8 sequences of one length [bytes]: (first byte & mask) == lead, code points from least_code_point.
struct SequenceKind {
    std::uint8_t mask, lead;
    std::size_t length;
    std::uint32_t least_code_point;
};
constexpr SequenceKind sequence_kinds[] = {
    {0x80, 0x00, 1, 0}, {0xe0, 0xc0, 2, 0x80}, {0xf0, 0xe0, 3, 0x800}, {0xf8, 0xf0, 4, 0x10000}};

struct Character {
    std::size_t length = 0;  ///< [bytes]; 0 for invalid UTF-8.
    std::uint32_t code_point = 0;
};

Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const auto* kind = std::find_if(std::begin(sequence_kinds), std::end(sequence_kinds),
                                    [&](const SequenceKind& k) { return (byte(0) & k.mask) == k.lead; });
    if (kind == std::end(sequence_kinds) || kind->length > text.size()) return {};
    std::uint32_t code_point = byte(0) & static_cast<std::uint8_t>(~kind->mask);
    for (std::size_t i = 1; i < kind->length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        code_point = code_point << 6 | (byte(i) & 0x3f);
    }
    const bool is_surrogate = code_point >= 0xd800 && code_point < 0xe000;
    if (code_point < kind->least_code_point || code_point > 0x10ffff || is_surrogate) return {};
    return {kind->length, code_point};
}

/// Unicode's Bidi_Control characters, which display a name in another order than its bytes.
bool is_bidirectional_control(std::uint32_t code_point) {
    return code_point == 0x61c || code_point == 0x200e || code_point == 0x200f ||
           (code_point >= 0x202a && code_point <= 0x202e) || (code_point >= 0x2066 && code_point <= 0x2069);
}

bool is_control(std::uint32_t code_point) {
    return code_point < 0x20 || (code_point >= 0x7f && code_point < 0xa0) || is_bidirectional_control(code_point);
}

bool is_escape(std::string_view text) {
    return text.size() >= escape_length && text.starts_with("\\x") &&
           text.substr(2, 2).find_first_not_of(hex_digits) == std::string_view::npos;
}

void append_escape(std::string& result, char c) {
    const auto byte = static_cast<std::uint8_t>(c);
    result += {'\\', 'x', hex_digits[byte >> 4], hex_digits[byte & 15]};
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Character c = first_character(text);
        const std::size_t length = std::max<std::size_t>(c.length, 1);
        if (c.length == 0 || is_control(c.code_point) || is_escape(text))
            for (const char byte : text.substr(0, length)) append_escape(result, byte);
        else
            result += text.substr(0, length);
        text.remove_prefix(length);
    }
    return result;
}

std::string unescaped(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const bool found = is_escape(text);
        result += found ? static_cast<char>(hex_digits.find(text[2]) << 4 | hex_digits.find(text[3])) : text[0];
        text.remove_prefix(found ? escape_length : 1);
    }
    return result;
}

}  // namespace interflect::detail
