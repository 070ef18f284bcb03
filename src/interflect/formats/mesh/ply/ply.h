#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads PLY faces (docs/files/formats.md). The reflectance is the vertex colour, if constant and in sRGB bytes, else
/// 0.5.
/// @throws InputError; see also scene_of().
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

Scene read_ply_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
