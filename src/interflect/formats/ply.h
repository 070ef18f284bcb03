#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads the faces of a PLY file (docs/formats.md). The reflectance is the colour of all vertices, if equal, else 0.5.
/// @throws InputError for invalid or truncated input and limits of `options`; also as scene_of().
/// @throws TooManyPatches
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

/// @param path  Name for messages.
Scene read_ply_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
