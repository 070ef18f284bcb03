#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads the faces of a PLY file, ASCII or binary of either byte order, as grey of a reflectance of 0.5, or of the
/// colour that all its vertices have; docs/formats.md tells more.
/// @throws InputError  for what is no such file, has less in it than its header tells, an index out of range, or goes
///         beyond a limit of `options`, and as scene_of() does; TooManyPatches.
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from memory. @param path  Name for messages.
Scene read_ply_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::inline detail
