#include "interflect/formats/text/line_reader.h"

#include <array>

namespace interflect::detail {

namespace {

enum class Kind : unsigned char { of_word, blank, backslash };

constexpr std::array<Kind, 256> kinds = [] {
    std::array<Kind, 256> result{};
    result[' '] = Kind::blank;
    for (std::size_t c = '\t'; c <= '\r'; ++c) result[c] = Kind::blank;
    result['\\'] = Kind::backslash;
    return result;
}();

Kind kind_of(char c) { return kinds[static_cast<unsigned char>(c)]; }

}  // namespace

bool LineReader::at_continuation(std::size_t offset) const {
    const std::string_view rest = text_.substr(offset, 3);
    return rest.starts_with("\\\n") || rest == "\\\r\n";
}

std::size_t LineReader::end_of_word(std::size_t offset) const {
    const std::string_view text = text_;
    while (offset < text.size()) {
        const Kind kind = kind_of(text[offset]);
        if (kind != Kind::of_word && (kind == Kind::blank || at_continuation(offset))) break;
        ++offset;
    }
    return offset;
}

bool LineReader::next() {
    words_.clear();
    while (words_.empty() && next_.offset < text_.size()) {
        const std::size_t start = next_.offset;
        line_ = next_.line;
        std::size_t i = start;
        for (bool line_goes_on = true; line_goes_on && i < text_.size();) {
            if (text_[i] == '\n') {
                line_goes_on = false;
                ++next_.line;
                ++i;
            } else if (kind_of(text_[i]) == Kind::blank) {
                ++i;
            } else if (kind_of(text_[i]) == Kind::backslash && at_continuation(i)) {
                i = text_.find('\n', i) + 1;
                ++next_.line;
            } else {
                const std::size_t word = i;
                i = end_of_word(i);
                words_.push_back(text_.substr(word, i - word));
            }
        }
        next_.offset = i;
        length_ = i - start;
    }
    return !words_.empty();
}

}  // namespace interflect::detail
