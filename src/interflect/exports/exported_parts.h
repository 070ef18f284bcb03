#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

// What exported text files have in common: names that any parser takes, and images beside the file.

/// Names of which each is different, not empty, and of letters, digits, '_', '-' and '.' alone: other bytes become '_',
/// and what is then taken gets a number. Begins with a letter or '_'.
/// @param kind  What a nameless thing is called.
std::vector<std::string> plain_names(const std::vector<std::string>& names, const char* kind);
std::vector<std::string> material_names(const Scene& scene);  ///< Of each material.
std::vector<std::string> object_names(const Scene& scene);    ///< Of each object.

/// The images of a scene's textures, in files beside `path`: PNG where that keeps every texel, else OpenEXR.
std::vector<ExportedFile> texture_files(const std::filesystem::path& path, const Scene& scene);

/// The bytes of an OpenEXR file with linear values.
std::string exr_bytes(const Texture& texture);

}  // namespace interflect::inline detail
