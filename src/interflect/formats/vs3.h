#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads View3D's scenes, format 3 and 3a (docs/formats.md). Each surface is an object; combined surfaces are one. Both
/// sides block: the fronts of radiating surfaces belong to their objects, all backs and obstructions to none.
/// @throws InputError; see also scene_of().
Scene read_vs3(const std::filesystem::path& path, const ReadOptions& options = {});

Scene read_vs3_bytes(std::string_view bytes, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
