#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

/// Renames temporary files when all are complete; returns the final paths.
/// @throws InputError for an invalid path; std::runtime_error if writing fails.
std::vector<std::filesystem::path> write_files(const std::vector<ExportedFile>& files);

}  // namespace interflect::detail
