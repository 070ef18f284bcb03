#pragma once

#include <string>
#include <string_view>

namespace interflect::detail {

/// Makes `text` safe to print and to put into JSON. Bytes of control characters (U+0000 to U+001F, U+007F to U+009F,
/// including line breaks) and of invalid UTF-8 become \xNN. The backslash of an existing escape sequence becomes \x5c,
/// which makes the result reversible. Cost: O(size).
std::string escaped(std::string_view text);

/// Inverse of escaped().
std::string unescaped(std::string_view text);

}  // namespace interflect::detail
