#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "interflect/scene.h"
#include "interflect/warnings.h"

namespace interflect {

struct SceneExportOptions {
    int width = 1280, height = 720;  ///< Size of the pictures [pixels], >= 1.
    int samples = 256;               ///< Samples per pixel, >= 1; Radiance has no such setting.
};

/// Files written, and warnings about unsupported features.
struct SceneExport {
    std::vector<std::filesystem::path> files;
    Warnings warnings;
};

/// Extensions of export_scene(): .rad (Radiance), .xml (Mitsuba 3), .pbrt (pbrt-v4), .py (a script for Blender).
extern const std::span<const char* const> scene_export_extensions;

/// Whether export_scene() supports the extension of this path.
bool is_scene_export(const std::filesystem::path& path);

/// Writes a scene for another renderer: faces with diffuse materials and images, emitters, light sources, skies as an
/// image, views as cameras. Referenced files are written beside it. Radiance is M / pi. Photometric values are kept,
/// except for Radiance, which needs them divided by 179 lm/W. Coordinates are relative to Scene::origin.
/// @throws InputError for an unknown extension, an option out of range and a path that cannot be written.
SceneExport export_scene(const std::filesystem::path& path, const Scene& scene, const SceneExportOptions& options = {});

}  // namespace interflect
