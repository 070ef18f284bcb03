#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "interflect/scene.h"
#include "interflect/warnings.h"

namespace interflect {

struct SceneExportOptions {
    int width = 1280, height = 720;  ///< Of the pictures [pixels], >= 1.
    int samples = 256;               ///< A pixel, >= 1; Radiance has no such setting.
};

/// What was written, and what of the scene the other program cannot have.
struct SceneExport {
    std::vector<std::filesystem::path> files;
    Warnings warnings;
};

/// The extensions of export_scene(): .rad (Radiance), .xml (Mitsuba 3), .pbrt (pbrt-v4), .py (a script for Blender).
extern const std::span<const char* const> scene_export_extensions;

/// Whether export_scene() takes a file of this name.
bool is_scene_export(const std::filesystem::path& path);

/// Writes a scene for another renderer, which is to find the same light: faces with their diffuse materials and images,
/// emitters, light sources, skies as an image, views as cameras. Files that it refers to go beside it. Radiance is
/// M / pi; what is photometric is handed over as it is, but to Radiance, whose watts are lumens / 179. Coordinates are
/// relative to Scene::origin.
/// @throws InputError for an unknown extension, an option out of range and a path that cannot be written.
SceneExport export_scene(const std::filesystem::path& path, const Scene& scene, const SceneExportOptions& options = {});

}  // namespace interflect
