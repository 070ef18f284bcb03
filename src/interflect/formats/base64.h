#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace interflect::inline detail {

/// The bytes of a base64 text (RFC 4648), with padding or without; nothing where it is none.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace interflect::inline detail
