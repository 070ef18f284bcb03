#pragma once

#include <filesystem>

namespace interflect::command {

/// Prints what is in a solution file and how it was found; as JSON, or for people.
void print_solution_info(const std::filesystem::path& path, bool json);

}  // namespace interflect::command
