#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace interflect::inline detail {

/// Reads a text file.
/// @throws InputError  if the path is not a readable regular file, or if the content is binary: control characters
///                     other than white space. That error names the line.
std::string read_text_file(const std::filesystem::path& path);

/// Reads a file. @param most  Size limit [bytes]. @throws InputError  if the file is unreadable or larger.
std::string read_bytes(const std::filesystem::path& path,
                       std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max());

/// Performs only the path checks.
void require_regular_file(const std::filesystem::path& path);

/// Returns whether a file is in a folder or below it, following links.
bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Performs only the check for control characters. @param path  Named in the error.
void require_text(std::string_view text, const std::filesystem::path& path);

}  // namespace interflect::inline detail
