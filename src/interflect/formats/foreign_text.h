#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace interflect::inline detail {

/// Replaces everything between the first and last quotation mark (') after `from` with "...". For messages about a file
/// that another file refers to: it may be any file of the machine, so its content must not reach the author of the
/// scene.
std::string without_quotes(std::string_view message, std::size_t from = 0);

}  // namespace interflect::inline detail
