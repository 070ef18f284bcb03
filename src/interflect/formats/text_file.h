#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace interflect::inline detail {

/// Reads a whole file of text.
/// @throws InputError where the path is missing, a folder or otherwise no regular file, cannot be read, or holds
/// control
///         characters other than white space (then it is not text; the error names the line).
std::string read_text_file(const std::filesystem::path& path);

/// Reads a whole file, whatever is in it. @param most  Bytes. @throws InputError where the path is not that of a file
/// that can be read, or it is larger.
std::string read_bytes(const std::filesystem::path& path,
                       std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max());

/// The checks of the path alone.
void require_regular_file(const std::filesystem::path& path);

/// Whether a file lies in a folder or below it, links followed.
bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder);

/// The check for control characters alone. @param path  Named in the error.
void require_text(std::string_view text, const std::filesystem::path& path);

}  // namespace interflect::inline detail
