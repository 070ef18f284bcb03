#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

/// Writes files, and renames them from temporary names when all are complete. @return  Their names.
/// @throws InputError for an invalid path; std::runtime_error if writing fails.
std::vector<std::filesystem::path> write_files(const std::vector<ExportedFile>& files);

}  // namespace interflect::detail
