#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads an STL file, with reflectance 0.5 (docs/formats.md).
/// @throws InputError for invalid input and limits of `options`; also as scene_of(). @throws TooManyPatches
Scene read_stl(const std::filesystem::path& path, const ReadOptions& options = {});

/// @param path  Name for messages.
Scene read_stl_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
