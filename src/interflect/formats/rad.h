#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads a Radiance scene (.rad, .mat); see docs/radiance.md. Lengths are as in the file. Radiance in W/(m^2 sr)
/// becomes exitance in lm/m^2 at 179 lm/W. Files must be in the scene's folder; no command is run.
/// @throws InputError  with file and line for invalid input, limits of `options`, and files outside the scene's folder;
///                     also as scene_of(). @throws TooManyPatches
Scene read_rad(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads from memory. @param path  Name for messages; other files are relative to its folder.
Scene read_rad_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
