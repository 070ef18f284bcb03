#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

/// Makes unique names that consist of letters, digits, '_', '-' and '.', and begin with a letter or '_'.
/// @param kind  Replaces an empty name.
/// @param most  Maximum length before a number is appended.
std::vector<std::string> plain_names(const std::vector<std::string>& names, const char* kind,
                                     std::size_t most = std::string::npos);
std::vector<std::string> material_names(const Scene& scene);
std::vector<std::string> object_names(const Scene& scene);

/// Returns the path of a file beside an export, such as "room-xml-sky.exr" for "room.xml" and "sky.exr". The format is
/// part of the name, so exports with the same stem in other formats have other names.
std::filesystem::path path_beside(const std::filesystem::path& path, const std::string& name);

/// Encodes textures beside `path`: PNG if lossless, otherwise OpenEXR.
std::vector<ExportedFile> texture_files(const std::filesystem::path& path, const Scene& scene);

/// Requires a UTF-8 stem without control characters, line breaks and `excluded`. @throws InputError
void require_nameable(const std::filesystem::path& path, std::string_view excluded);

/// Escapes text for double quotes in Python, pbrt and C.
std::string quotable(std::string_view text);
std::string xml_text(std::string_view text);

std::string exr_bytes(const Texture& texture);
std::string hdr_bytes(const Texture& texture);

}  // namespace interflect::detail
