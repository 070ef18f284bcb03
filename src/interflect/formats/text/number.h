#pragma once

#include <optional>
#include <string_view>

namespace interflect::detail {

/// Parses a decimal number that fills `text` and is finite in single precision. Accepts '+'. Independent of the locale.
std::optional<double> parse_number(std::string_view text);

std::optional<int> parse_integer(std::string_view text);

}  // namespace interflect::detail
