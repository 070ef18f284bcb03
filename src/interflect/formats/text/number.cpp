#include "interflect/formats/text/number.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace interflect::detail {

namespace {

template <class T>
std::optional<T> parse_all(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
    const std::optional<double> value = parse_all<double>(text);
    // The comparison is false for NaN.
    if (!value || !(std::abs(*value) <= std::numeric_limits<float>::max())) return std::nullopt;
    return value;
}

std::optional<int> parse_integer(std::string_view text) { return parse_all<int>(text); }

}  // namespace interflect::detail
