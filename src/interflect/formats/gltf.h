#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads a glTF 2.0 file, .gltf or .glb: docs/gltf.md tells what of it, and how it is mapped.
/// @throws InputError that names the file and the place in it, as scene_of() does, and beyond the limits of `options`.
Scene read_gltf(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from memory. @param path  Name for messages; files that it names are looked for in its folder.
Scene read_gltf_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options);

}  // namespace interflect::inline detail
