#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace interflect::detail {

/// Replaces the text between the first and last quotation mark (') after `from` by "...", so messages do not reveal the
/// content of referenced files.
std::string without_quotes(std::string_view message, std::size_t from = 0);

}  // namespace interflect::detail
