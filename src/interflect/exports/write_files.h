#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

/// Writes files that belong together: each appears under its name when all are complete. @return  Their names.
/// @throws InputError for a path that cannot be written; std::runtime_error where writing fails.
std::vector<std::filesystem::path> write_files(const std::vector<ExportedFile>& files);

}  // namespace interflect::inline detail
