#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads STL, with reflectance 0.5 (docs/files/formats.md). @throws InputError; see also scene_of().
Scene read_stl(const std::filesystem::path& path, const ReadOptions& options = {});

Scene read_stl_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
