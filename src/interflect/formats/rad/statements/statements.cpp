#include "interflect/formats/rad/statements/statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "interflect/formats/text/number.h"

namespace interflect::detail {

namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

void RadStatements::skip_blanks() {
    for (; offset_ < text_.size() && is_space(text_[offset_]); ++offset_) line_of_offset_ += text_[offset_] == '\n';
}

RadStatements::Kind RadStatements::next() {
    skip_blanks();
    while (offset_ < text_.size() && text_[offset_] == '#') {
        offset_ = std::min(text_.find('\n', offset_), text_.size());
        skip_blanks();
    }
    line_ = line_of_offset_;
    if (offset_ == text_.size()) return Kind::end;
    return text_[offset_] == '!' ? Kind::command : Kind::primitive;
}

std::string RadStatements::command() {
    std::string command;
    for (++offset_; offset_ < text_.size() && text_[offset_] != '\n'; ++offset_) {
        if (text_[offset_] == '\\' && text_.substr(offset_ + 1).starts_with('\n')) {
            ++offset_;
            ++line_of_offset_;
            command += ' ';
        } else {
            command += text_[offset_];
        }
    }
    return command;
}

std::string_view RadStatements::word(std::string_view expected) {
    skip_blanks();
    if (offset_ == text_.size())
        throw std::invalid_argument(fmt::format("the file ends where {} is expected", expected));
    const char quote = text_[offset_] == '"' || text_[offset_] == '\'' ? text_[offset_] : '\0';
    if (quote) ++offset_;
    const std::size_t begin = offset_;
    const auto is_end = [&](char c) { return quote ? c == quote || c == '\n' : is_space(c); };
    while (offset_ < text_.size() && !is_end(text_[offset_])) ++offset_;
    const std::string_view result = text_.substr(begin, offset_ - begin);
    if (quote && offset_ < text_.size() && text_[offset_] == quote) ++offset_;
    return result;
}

std::size_t RadStatements::count(std::string_view kind) {
    const std::string_view text = word(fmt::format("the number of {}", kind));
    const auto number = parse_integer(text);
    if (!number || *number < 0)
        throw std::invalid_argument(fmt::format("expected the number of {}, not '{}'", kind, text));
    return static_cast<std::size_t>(*number);
}

RadPrimitive RadStatements::primitive() {
    RadPrimitive result;
    result.modifier = word("a modifier");
    result.type = word("a type");
    result.name = word("a name");
    if (result.type == "alias") {
        result.original = word("the original of the alias");
        return result;
    }
    const auto arguments = [&](std::string_view what, auto use) {
        for (std::size_t left = count(what); left > 0; --left) use(word(fmt::format("one of {} more {}", left, what)));
    };
    arguments("strings", [&](std::string_view text) { result.strings.push_back(text); });
    arguments("integers", [](std::string_view) {});  // unused
    arguments("numbers", [&](std::string_view text) {
        const auto number = parse_number(text);
        if (!number) throw std::invalid_argument(fmt::format("expected a finite number, not '{}'", text));
        result.numbers.push_back(*number);
    });
    return result;
}

}  // namespace interflect::detail
