#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

/// A solved scene as glTF 2.0 (docs/export.md): of each object a mesh, with the light in its vertices or in lightmaps;
/// the scene's views as cameras; turned to y up.
std::vector<ExportedFile> make_glb(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// The same as JSON, with everything binary in it as text.
std::vector<ExportedFile> make_gltf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                    const ExportOptions& options);

}  // namespace interflect::inline detail
