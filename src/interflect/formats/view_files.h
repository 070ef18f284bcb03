#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns /a/office.views.json for /a/office.mgf.
std::filesystem::path view_list_path(const std::filesystem::path& scene_path);

/// Reads named views, in metres and degrees (docs/guides/command-line.md). `up` defaults to (0, 0, 1) and `fov` to 45.
/// @throws InputError for invalid or unknown members, and duplicate names.
std::vector<View> read_view_list(const std::filesystem::path& path);

/// Omits `extent`. @param views  With unique names. @throws std::runtime_error
void write_view_list(std::span<const View> views, const std::filesystem::path& path);

/// Reads a Radiance view (rvu options), named after the file, with Radiance's defaults; later lines override. Ignores
/// -vh, which follows from the picture's shape.
/// @throws InputError, also for projections other than -vtv, shift, lift or clipping planes.
View read_radiance_view(const std::filesystem::path& path);

}  // namespace interflect::detail
