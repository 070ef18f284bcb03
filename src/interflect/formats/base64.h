#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace interflect::detail {

/// Decodes base64 (RFC 4648), padded or not; nullopt if invalid.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace interflect::detail
