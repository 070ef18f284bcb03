#pragma once

#include <string>
#include <string_view>

namespace interflect::inline detail {

/// `text`, safe to print on a terminal and to put into JSON: each byte of a control character (U+0000 to U+001F, U+007F
/// to U+009F, line breaks too), and each byte that is not part of valid UTF-8, becomes \xNN. A backslash that begins
/// what looks like such an escape becomes \x5c, so that nothing is lost. Cost: O(size).
std::string escaped(std::string_view text);

/// What escaped() was given.
std::string unescaped(std::string_view text);

}  // namespace interflect::inline detail
