#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

// Exporters of solved scenes as meshes of their leaves, in world coordinates. Layouts: docs/exported-scenes.md.

/// Binary PLY: polygons with colours and irradiance at their vertices.
std::vector<ExportedFile> make_ply(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// VTK unstructured grid for ParaView: all quantities of the elements, and the light at their vertices.
std::vector<ExportedFile> make_vtu(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// The same grid as compressed VTKHDF.
std::vector<ExportedFile> make_vtkhdf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions& options);
/// Wavefront OBJ with vertex colours; a material file and texture images beside it.
std::vector<ExportedFile> make_obj(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);

}  // namespace interflect::inline detail
