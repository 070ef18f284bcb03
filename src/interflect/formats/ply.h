#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads the faces of a PLY file, ASCII or binary of either byte order. The reflectance is 0.5, or the colour shared by
/// all vertices; see docs/formats.md.
/// @throws InputError  for invalid or truncated input and limits of `options`; also as scene_of().
///                     @throws TooManyPatches
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads from memory. @param path  Name for messages.
Scene read_ply_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
