#pragma once

#include <filesystem>

#include "interflect/formats/read_options.h"
#include "interflect/formats/view_files.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// Reads a scene, in the format that the file name's extension tells (.mgf), and its named views, where the file of
/// view_list_path() is there. The result has no scene_faults(). A scene without any light gets the warning "no-light".
/// @throws InputError  for an unknown extension, and as the readers do.
Scene load_scene(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect
