#pragma once

#include <filesystem>
#include <span>

#include "interflect/daylight.h"
#include "interflect/load_luminaire.h"
#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect {

/// Reads a scene in the format of the file name's extension (.mgf, .gltf, .glb, .obj, .ply, .rad, .stl), and its named
/// views if the file view_list_path() exists. The result has no scene_faults(). A scene without light gets the warning
/// "no-light".
///
/// Instead of a file, `maze:ROOMS` or `maze:ROOMS:furniture` creates that maze and its views in memory (make_maze(),
/// other options at their defaults). `maze:9:furniture` has the size of the scene in Prikryl et al. 2000.
/// @param luminaires  Added to the scene; each is named by its file and its index among the scene's lights: "lamp-3".
/// @param added       Added after them, as by add_daylight().
/// @throws InputError for an unknown extension, as the readers do, and for an invalid maze; TooManyPatches if the scene
///         has more than options.max_patches.
Scene load_scene(const std::filesystem::path& path, const ReadOptions& options = {},
                 std::span<const PlacedLuminaire> luminaires = {}, const Daylight& added = {});

}  // namespace interflect
