#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "interflect/scene.h"

namespace interflect::command {

struct NamedFile {
    std::string_view argument;   ///< Such as '--stats'.
    std::filesystem::path path;  ///< Empty if not given.
};

/// @throws UsageError if an output is an input or another output. Devices may repeat.
void require_distinct_files(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs);

/// @throws UsageError if an output is one of Scene::files.
void refuse_overwriting(const Scene& scene, std::span<const NamedFile> outputs);

/// Returns the extension with ASCII letters in lower case.
std::string lower_case_extension(const std::filesystem::path& path);

/// @param output  Receives a table or JSON.
/// @throws UsageError if its name ends like that of a scene, a solution, a picture or another kind of file.
void require_text_name(const NamedFile& output);

}  // namespace interflect::command
