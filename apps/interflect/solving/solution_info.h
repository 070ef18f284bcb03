#pragma once

#include <filesystem>

namespace interflect::command {

/// Prints the content and options of a solution file as JSON or text.
void print_solution_info(const std::filesystem::path& path, bool json);

}  // namespace interflect::command
