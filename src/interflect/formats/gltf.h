#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads a glTF 2.0 file, .gltf or .glb (docs/gltf.md).
/// @throws InputError for invalid input and limits of `options`; also as scene_of().
Scene read_gltf(const std::filesystem::path& path, const ReadOptions& options = {});

/// @param path  Name for messages; its folder contains referenced files.
Scene read_gltf_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options);

}  // namespace interflect::detail
