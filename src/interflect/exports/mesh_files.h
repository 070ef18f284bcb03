#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

// Meshes of leaves in world coordinates (docs/exported-scenes.md).

/// Binary PLY with colours and irradiance at vertices.
std::vector<ExportedFile> make_ply(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// VTK unstructured grid with all quantities of elements, and light at vertices.
std::vector<ExportedFile> make_vtu(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
std::vector<ExportedFile> make_vtkhdf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions& options);
/// Wavefront OBJ with vertex colours, materials and textures.
std::vector<ExportedFile> make_obj(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);

}  // namespace interflect::detail
