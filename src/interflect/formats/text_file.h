#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace interflect::detail {

/// Removes the byte order mark. @throws InputError as read_bytes() and require_text().
std::string read_text_file(const std::filesystem::path& path);

/// @param most  [bytes]. @throws InputError if unreadable or larger.
std::string read_bytes(const std::filesystem::path& path,
                       std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max());

/// @throws InputError
void require_regular_file(const std::filesystem::path& path);

/// Follows links; includes subfolders.
bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder);

/// @throws InputError for control characters other than white space.
void require_text(std::string_view text, const std::filesystem::path& path);

}  // namespace interflect::detail
