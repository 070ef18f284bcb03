#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Returns the path of a scene's named views: /a/office.views.json for /a/office.mgf.
std::filesystem::path view_list_path(const std::filesystem::path& scene_path);

/// Reads named views: {"views": [{"name": "desk", "eye": [x, y, z], "look_at": [x, y, z], "up": [x, y, z], "fov":
/// 45}]}, in metres and degrees (vertical, full). `up` defaults to (0, 0, 1) and `fov` to 45; the other keys are
/// required.
/// @throws InputError  with file, view and key for invalid JSON, unknown or missing keys, values of wrong type or
///                     range, duplicate names, and views without a direction (`up` included).
std::vector<View> read_view_list(const std::filesystem::path& path);

/// Writes named views so that read_view_list() restores all values except `extent`, which the format lacks.
/// @param views  Names must be unique. @throws std::runtime_error  if writing fails.
void write_view_list(std::span<const View> views, const std::filesystem::path& path);

/// Reads a Radiance view file, such as `rvu -vtv -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 45`. Defaults are those of
/// Radiance (eye at the origin, direction y, up z, 45 degrees); later lines override earlier ones. The field of view is
/// the vertical one (-vv); the picture's shape determines the horizontal one. The view is named after the file.
/// @throws InputError  with file and line for views that are not perspective (-vtv) or have shift, lift or clipping
///                     planes, for unknown options, and for invalid values.
View read_radiance_view(const std::filesystem::path& path);

}  // namespace interflect::inline detail
