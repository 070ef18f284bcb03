#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

// Meshes of leaves in world coordinates (docs/files/exported-scenes.md).

std::vector<ExportedFile> make_ply(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
std::vector<ExportedFile> make_vtu(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
std::vector<ExportedFile> make_vtkhdf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions& options);
std::vector<ExportedFile> make_obj(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);

}  // namespace interflect::detail
