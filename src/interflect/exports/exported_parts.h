#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

// Helpers of the exporters: names that any parser accepts, and image files beside the exported file.

/// Makes names unique, non-empty and free of characters other than letters, digits, '_', '-' and '.'. Replaces other
/// bytes by '_' and numbers duplicates. Each result begins with a letter or '_'.
/// @param kind  Replaces an empty name.
/// @param most  Maximum length [characters] before a number is appended; longer names are truncated.
std::vector<std::string> plain_names(const std::vector<std::string>& names, const char* kind,
                                     std::size_t most = std::string::npos);
/// Returns plain names of the materials, short enough for file names.
std::vector<std::string> material_names(const Scene& scene);
std::vector<std::string> object_names(const Scene& scene);  ///< One name per object.

/// Encodes the scene's textures as files beside `path`: PNG if it is lossless, otherwise OpenEXR.
std::vector<ExportedFile> texture_files(const std::filesystem::path& path, const Scene& scene);

/// Requires a stem that the text of an exported file can contain: UTF-8 without control characters, line breaks and
/// characters of `excluded`. @throws InputError
void require_nameable(const std::filesystem::path& path, std::string_view excluded);

/// Escapes text for the double quotes of Python, pbrt and C: adds backslashes before quotes and backslashes.
std::string quotable(std::string_view text);
/// Escapes text for an XML attribute.
std::string xml_text(std::string_view text);

/// Encodes a texture as OpenEXR with linear values.
std::string exr_bytes(const Texture& texture);

}  // namespace interflect::inline detail
