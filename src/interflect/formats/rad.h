#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads a Radiance scene (.rad, .mat); docs/radiance.md lists the primitives. Lengths are as in the file. Radiance in
/// W/(m^2 sr) becomes exitance in lm/m^2 at 179 lm/W. Reads only files in the scene's folder and runs no command.
/// @throws InputError  with file and line for invalid content, an exceeded limit of `options`, a file outside the
///                     scene's folder, and the errors of scene_of(). @throws TooManyPatches
Scene read_rad(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads from memory. @param path  Name for messages; other files are relative to its folder.
Scene read_rad_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::inline detail
