#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads a Radiance scene (.rad, .mat); docs/radiance.md tells what becomes of each primitive. Lengths are as in the
/// file; radiance, in W/(m^2 sr), becomes exitance in lm/m^2 at 179 lm/W. Only files in the scene's folder are read,
/// and no command is run.
/// @throws InputError  with file and line, for what is no Radiance scene, beyond a limit of `options`, or outside the
///         scene's folder, and as scene_of() does; TooManyPatches.
Scene read_rad(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from memory. @param path  Name for messages; its folder is where other files are looked for.
Scene read_rad_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::inline detail
