#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "interflect/base/files/input_file.h"

namespace interflect::detail {

/// Reads a text file without its byte order mark. @throws InputError as read_bytes() and require_text().
std::string read_text_file(const std::filesystem::path& path);

/// Returns whether a path is inside a folder or its subfolders. Follows links.
bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder);

/// @throws InputError for control characters other than white space.
void require_text(std::string_view text, const std::filesystem::path& path);

}  // namespace interflect::detail
