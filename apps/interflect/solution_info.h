#pragma once

#include <filesystem>

namespace interflect::command {

/// Prints the content and the options of a solution file, as JSON or as text.
void print_solution_info(const std::filesystem::path& path, bool json);

}  // namespace interflect::command
