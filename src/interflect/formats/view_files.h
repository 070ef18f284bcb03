#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Reads named views, in metres and degrees (docs/guides/command-line.md). `up` defaults to (0, 0, 1) and `fov` to 45.
/// @throws InputError for invalid or unknown members, and duplicate names.
std::vector<View> read_view_list(const std::filesystem::path& path);

/// Writes views without `extent`. @param views  Views with unique names. @throws std::runtime_error
void write_view_list(std::span<const View> views, const std::filesystem::path& path);

}  // namespace interflect::detail
