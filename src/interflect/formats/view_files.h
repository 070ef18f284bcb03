#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Where the named views of a scene are kept: /a/office.mgf has them in /a/office.views.json.
std::filesystem::path view_list_path(const std::filesystem::path& scene_path);

/// Reads named views: {"views": [{"name": "desk", "eye": [x, y, z], "look_at": [x, y, z], "up": [x, y, z], "fov":
/// 45}]}, in metres and degrees (vertical, full). `up` is (0, 0, 1) and `fov` is 45 where they are missing; the others
/// are required.
/// @throws InputError  with file, view and key, where the file is no JSON, a key is unknown or missing, a value is of
/// the
///         wrong kind or range, two views have one name, or a view has no direction (`up` included).
std::vector<View> read_view_list(const std::filesystem::path& path);

/// Writes named views in that form, so that read_view_list() gives them back exactly.
/// @param views  Each with a name of its own. @throws std::runtime_error where the file cannot be written.
void write_view_list(std::span<const View> views, const std::filesystem::path& path);

/// Reads a Radiance view file, such as `rvu -vtv -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 45`. What is missing is as in
/// Radiance (eye at the origin, direction y, up z, 45 degrees); where the file has several lines, later options
/// override. The field of view is the vertical one (-vv), as the horizontal follows from the picture's shape. The view
/// is named after the file.
/// @throws InputError  with file and line, for anything but perspective views (-vtv) without shift, lift or clipping
/// planes,
///         for unknown options, and for values that make no view.
View read_radiance_view(const std::filesystem::path& path);

}  // namespace interflect::inline detail
