#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace interflect::command {

struct NamedFile {
    std::string_view argument;   ///< Such as '--stats'.
    std::filesystem::path path;  ///< Empty if not given.
};

/// @throws UsageError if an output is an input or another output. Devices may repeat.
void require_distinct_files(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs);

}  // namespace interflect::command
