#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

// What exported text files have in common: names that any parser takes, and images beside the file.

/// Names of which each is different, not empty, and of letters, digits, '_', '-' and '.' alone: other bytes become '_',
/// and what is then taken gets a number. Begins with a letter or '_'.
/// @param kind  What a nameless thing is called.
/// @param most  Characters of a name; the rest of a longer one is left out.
std::vector<std::string> plain_names(const std::vector<std::string>& names, const char* kind,
                                     std::size_t most = std::string::npos);
/// Plain names of the materials, short enough for names of files.
std::vector<std::string> material_names(const Scene& scene);
std::vector<std::string> object_names(const Scene& scene);  ///< By object.

/// The images of a scene's textures, in files beside `path`: PNG where that keeps every texel, else OpenEXR.
std::vector<ExportedFile> texture_files(const std::filesystem::path& path, const Scene& scene);

/// Refuses a stem that the text of an exported file cannot name: control characters (line breaks too), bytes that are
/// no UTF-8, and characters of `excluded`. @throws InputError
void require_nameable(const std::filesystem::path& path, std::string_view excluded);

/// Text within the double quotes of Python, pbrt and C: with backslashes before quotes and backslashes.
std::string quotable(std::string_view text);
/// Text within an attribute of XML.
std::string xml_text(std::string_view text);

/// The bytes of an OpenEXR file with linear values.
std::string exr_bytes(const Texture& texture);

}  // namespace interflect::inline detail
