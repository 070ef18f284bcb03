#pragma once

#include <filesystem>
#include <span>

#include "interflect/daylight.h"
#include "interflect/load_luminaire.h"
#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect {

/// Reads a scene, in the format that the file name's extension tells (.mgf, .gltf, .glb), and its named views, where
/// the file of view_list_path() is there. The result has no scene_faults(). A scene without any light gets the warning
/// "no-light".
///
/// In place of a file, `maze:ROOMS` or `maze:ROOMS:furniture` makes that maze in memory (make_maze(), its other options
/// at their defaults), with its views: `maze:9:furniture` is the size of the scene in Prikryl et al. 2000.
/// @param luminaires  Are placed in it; each is named by its file and its place among the scene's lights: "lamp-3".
/// @param added       Is added to it after them, as add_daylight() does.
/// @throws InputError  for an unknown extension, as the readers do, and for a maze that is not as above; TooManyPatches
///         where the scene has more than options.max_patches.
Scene load_scene(const std::filesystem::path& path, const ReadOptions& options = {},
                 std::span<const PlacedLuminaire> luminaires = {}, const Daylight& added = {});

}  // namespace interflect
