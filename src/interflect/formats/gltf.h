#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads a glTF 2.0 file (.gltf or .glb); see docs/gltf.md.
/// @throws InputError  with file and place; also as scene_of() and beyond the limits of `options`.
Scene read_gltf(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads from memory. @param path  Name for messages; other files are relative to its folder.
Scene read_gltf_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options);

}  // namespace interflect::detail
