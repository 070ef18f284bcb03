#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace interflect::detail {

/// Replaces the text between the first and last quotation mark (') after `from` by "...". An apostrophe within a word
/// before them ("the lamp's") is no quotation mark. Used for files that other files refer to: they may be any file, so
/// messages must not reveal their content.
std::string without_quotes(std::string_view message, std::size_t from = 0);

}  // namespace interflect::detail
