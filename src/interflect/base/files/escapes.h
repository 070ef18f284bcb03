#pragma once

#include <string>
#include <string_view>

namespace interflect::detail {

/// Replaces bytes of control characters (U+0000 to U+001F, U+007F to U+009F, Bidi_Control) and invalid UTF-8 by \xNN,
/// for terminals and JSON. Reversible: the backslash of an existing \xNN becomes \x5c.
std::string escaped(std::string_view text);

std::string unescaped(std::string_view text);

}  // namespace interflect::detail
