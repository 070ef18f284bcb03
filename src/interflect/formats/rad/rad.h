#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads a Radiance scene without running commands (docs/files/radiance.md). Radiance [W/(m^2 sr)] becomes exitance
/// [lm/m^2] at 179 lm/W. ReadOptions::further_files continue the scene. @throws InputError; see also scene_of().
Scene read_rad(const std::filesystem::path& path, const ReadOptions& options = {});

Scene read_rad_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
