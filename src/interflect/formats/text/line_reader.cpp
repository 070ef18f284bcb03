#include "interflect/formats/text/line_reader.h"

namespace interflect::detail {

namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

bool LineReader::at_continuation(std::size_t offset) const {
    if (text_[offset] != '\\') return false;
    const std::string_view rest = text_.substr(offset, 3);
    return rest.starts_with("\\\n") || rest == "\\\r\n";
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
            } else if (at_continuation(i)) {
                i = text_.find('\n', i) + 1;
                ++next_.line;
            } else if (is_blank(text_[i])) {
                ++i;
            } else {
                const std::size_t word = i;
                while (i < text_.size() && !is_blank(text_[i]) && !at_continuation(i)) ++i;
                words_.push_back(text_.substr(word, i - word));
            }
        }
        next_.offset = i;
        length_ = i - start;
    }
    return !words_.empty();
}

}  // namespace interflect::detail
