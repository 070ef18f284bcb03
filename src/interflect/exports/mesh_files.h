#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

// Solved scenes as meshes of their leaves: docs/exported-scenes.md has the layouts. World coordinates, not turned.

/// Binary PLY: polygons with colours and irradiance at their vertices.
std::vector<ExportedFile> make_ply(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// VTK's unstructured grid, for ParaView: every quantity of the elements, and the light at their vertices.
std::vector<ExportedFile> make_vtu(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// The same grid as VTKHDF, compressed.
std::vector<ExportedFile> make_vtkhdf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions& options);
/// Wavefront OBJ with colours at the vertices, a file of materials and the images of their textures beside it.
std::vector<ExportedFile> make_obj(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);

}  // namespace interflect::inline detail
