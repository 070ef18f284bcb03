#pragma once

#include <optional>
#include <string_view>

namespace interflect::inline detail {

/// Reads a decimal number that takes up the whole of `text` and is finite in single precision; nothing otherwise, so
/// also for nan, inf, 1e39, hexadecimal and trailing characters. A leading '+' is understood. Does not use the locale.
std::optional<double> parse_number(std::string_view text);

/// The same for a whole number that fits an int.
std::optional<int> parse_integer(std::string_view text);

}  // namespace interflect::inline detail
