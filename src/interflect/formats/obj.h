#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads a Wavefront OBJ file with its material libraries; docs/formats.md tells what is read, and how.
/// @throws InputError  with file and line, for what is no OBJ file, an index out of range, a limit of `options` that is
///         passed, or a file outside the scene's folder, and as scene_of() does; TooManyPatches.
Scene read_obj(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from memory. @param path  Name for messages; its folder is where other files are looked for.
Scene read_obj_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::inline detail
