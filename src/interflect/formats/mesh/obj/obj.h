#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads Wavefront OBJ with its material libraries (docs/files/formats.md). @throws InputError; see also scene_of().
Scene read_obj(const std::filesystem::path& path, const ReadOptions& options = {});

Scene read_obj_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
