#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace interflect::inline detail {

/// `message` without quoted words: "..." replaces everything between the first and the last quotation mark (') after
/// `from`. For messages about a file that another file names: such a file may be any file of the machine, and its
/// content is not for the author of the scene.
std::string without_quotes(std::string_view message, std::size_t from = 0);

}  // namespace interflect::inline detail
