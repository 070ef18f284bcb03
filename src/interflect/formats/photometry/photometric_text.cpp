#include "interflect/formats/photometry/photometric_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interflect/core.h"
#include "interflect/formats/text/number.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

namespace {

bool is_white_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view shown(std::string_view word) {
    constexpr std::size_t most = 40;  // [characters]
    return word.substr(0, most);
}

}  // namespace

std::string read_photometric_text(const std::filesystem::path& path, const ReadOptions& options) {
    std::string text = read_bytes(path, options.max_photometric_bytes);
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
    constexpr char end_of_file = 0x1a;  // end mark of MS-DOS
    while (!text.empty() && (text.back() == end_of_file || is_white_space(text.back()))) text.pop_back();
    require_text(text, path);
    return text;
}

bool PhotometricText::is_separator(char c) const {
    return is_white_space(c) || separators_.find(c) != separators_.npos;
}

/// Moves to `end` and counts line breaks.
void PhotometricText::skip(std::size_t end) {
    for (; next_ < end; ++next_)
        if (text_[next_] == '\n' || (text_[next_] == '\r' && !text_.substr(next_ + 1).starts_with('\n'))) ++next_line_;
}

std::optional<std::string_view> PhotometricText::line() {
    if (next_ >= text_.size()) return std::nullopt;
    line_ = next_line_;
    const std::size_t end = std::min(text_.find_first_of("\r\n", next_), text_.size());
    std::string_view result = text_.substr(next_, end - next_);
    skip(std::min(end + (text_.substr(end).starts_with("\r\n") ? 2 : 1), text_.size()));
    while (!result.empty() && is_white_space(result.front())) result.remove_prefix(1);
    while (!result.empty() && is_white_space(result.back())) result.remove_suffix(1);
    return result;
}

std::optional<std::string_view> PhotometricText::word() {
    std::size_t begin = next_;
    while (begin < text_.size() && is_separator(text_[begin])) ++begin;
    skip(begin);
    if (begin == text_.size()) return std::nullopt;
    line_ = next_line_;
    while (next_ < text_.size() && !is_separator(text_[next_])) ++next_;
    return text_.substr(begin, next_ - begin);
}

double PhotometricText::number(const std::string& what) {
    const auto text = word();
    if (!text) refuse(fmt::format("the file ends before {}", what));
    return number_of(*text, what);
}

double PhotometricText::number_of(std::string_view word, const std::string& what) {
    if (const auto value = parse_number(word)) return *value;
    std::string with_point(word);
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    const auto value = parse_number(with_point);
    if (!value) refuse(fmt::format("expected {}, found '{}'", what, shown(word)));
    had_decimal_comma_ = true;
    return *value;
}

std::size_t PhotometricText::count(const std::string& what, std::size_t least, std::size_t most) {
    const double value = number(what);
    if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most)) || value != std::floor(value))
        refuse(fmt::format("{} is {}; expected a whole number from {} to {}", what, value, least, most));
    return static_cast<std::size_t>(value);
}

std::vector<double> PhotometricText::numbers(std::size_t count, const std::string& what) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(number(what));
    return values;
}

std::string PhotometricText::where() const { return fmt::format("{}:{}", path_.string(), line_); }

void PhotometricText::refuse(const std::string& message, const std::string& setting) const {
    throw InputError(Fault{.text = message, .setting = setting, .file = path_, .line = line_});
}

}  // namespace interflect::detail
