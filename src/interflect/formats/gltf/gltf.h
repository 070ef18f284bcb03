#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/formats/build/model.h"
#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads glTF 2.0, .gltf or .glb (docs/files/gltf.md). @throws InputError; see also scene_of().
Scene read_gltf(const std::filesystem::path& path, const ReadOptions& options = {});

/// Returns the meshes and lights of a file, with their places in it (Mesh::source).
Model read_gltf_model(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options);

Scene read_gltf_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options);

}  // namespace interflect::detail
