#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace interflect::detail {

/// Decodes RFC 4648; padding is optional.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace interflect::detail
