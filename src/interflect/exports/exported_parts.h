#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

// Helpers of the exporters.

/// Makes names unique, non-empty and of letters, digits, '_', '-' and '.' alone, with a letter or '_' first.
/// @param kind  Replaces an empty name.
/// @param most  Truncates longer names [characters]; a number may follow.
std::vector<std::string> plain_names(const std::vector<std::string>& names, const char* kind,
                                     std::size_t most = std::string::npos);
/// Returns names short enough for file names.
std::vector<std::string> material_names(const Scene& scene);
std::vector<std::string> object_names(const Scene& scene);  ///< One name per object.

/// Encodes textures beside `path`: PNG if that is lossless, otherwise OpenEXR.
std::vector<ExportedFile> texture_files(const std::filesystem::path& path, const Scene& scene);

/// Requires a stem in UTF-8 without control characters, line breaks and characters of `excluded`. @throws InputError
void require_nameable(const std::filesystem::path& path, std::string_view excluded);

/// Escapes text for double quotes in Python, pbrt and C.
std::string quotable(std::string_view text);
/// Escapes text for an XML attribute.
std::string xml_text(std::string_view text);

std::string exr_bytes(const Texture& texture);

}  // namespace interflect::detail
