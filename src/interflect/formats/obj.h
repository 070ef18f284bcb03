#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads a Wavefront OBJ file with its material libraries (docs/formats.md).
/// @throws InputError for invalid input, limits of `options` and files outside the scene's folder; also as scene_of().
/// @throws TooManyPatches
Scene read_obj(const std::filesystem::path& path, const ReadOptions& options = {});

/// @param path  Name for messages; its folder contains referenced files.
Scene read_obj_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
