#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads the triangles of an STL file, ASCII or binary, as grey of a reflectance of 0.5; docs/formats.md tells more.
/// @throws InputError  for what is no such file or goes beyond a limit of `options`, and as scene_of() does;
///         TooManyPatches.
Scene read_stl(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from memory. @param path  Name for messages.
Scene read_stl_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::inline detail
