#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

/// Writes all files under temporary names, and renames them when all are complete. Returns the final paths.
/// @throws InputError for an invalid path; std::runtime_error if writing fails.
std::vector<std::filesystem::path> write_files(const std::vector<ExportedFile>& files);

}  // namespace interflect::detail
