#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace interflect::detail {

/// Replaces the text from the first to the last quote (') after `from` by "...", to hide content of referenced files.
std::string without_quotes(std::string_view message, std::size_t from = 0);

}  // namespace interflect::detail
