#include "interflect/formats/text/foreign_text.h"

namespace interflect::detail {

namespace {

bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

/// Returns the position of the first quotation mark. Skips apostrophes, which follow a letter or digit.
std::size_t opening_mark(std::string_view message, std::size_t from) {
    std::size_t mark = message.find('\'', from);
    while (mark != message.npos && mark > 0 && is_word(message[mark - 1])) mark = message.find('\'', mark + 1);
    return mark;
}

}  // namespace

std::string without_quotes(std::string_view message, std::size_t from) {
    const std::size_t first = opening_mark(message, from);
    if (first == message.npos) return std::string(message);
    const std::size_t last = message.rfind('\'');
    const std::size_t rest = last > first ? last + 1 : message.size();
    return std::string(message.substr(0, first)) + "..." + std::string(message.substr(rest));
}

}  // namespace interflect::detail
