#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace interflect::command {

/// A file of a command line.
struct NamedFile {
    std::string_view argument;   ///< What it was given as, such as '--stats'.
    std::filesystem::path path;  ///< Empty: it was not given.
};

/// @throws UsageError if an output is an input or another output: one would overwrite the other. Devices may be named
/// twice.
void require_distinct_files(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs);

}  // namespace interflect::command
