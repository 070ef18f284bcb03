#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads View3D's scenes, format 3 and 3a (docs/files/formats.md), as one-sided faces. Each radiating surface is an
/// object; combined surfaces are one. Obstructions and null surfaces have no object.
/// @throws InputError; see also scene_of().
Scene read_vs3(const std::filesystem::path& path, const ReadOptions& options = {});

Scene read_vs3_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
