#pragma once

#include <string>
#include <string_view>

namespace interflect::inline detail {

/// Makes `text` safe to print on a terminal and to put into JSON. Each byte of a control character (U+0000 to U+001F,
/// U+007F to U+009F, including line breaks) and each byte of invalid UTF-8 becomes \xNN. The backslash of an existing
/// escape sequence becomes \x5c, so the result is reversible. Cost: O(size).
std::string escaped(std::string_view text);

/// Inverse of escaped().
std::string unescaped(std::string_view text);

}  // namespace interflect::inline detail
