#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

/// Exports binary glTF 2.0 (docs/export.md), y up, with light at vertices or in lightmaps.
std::vector<ExportedFile> make_glb(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// Exports JSON with embedded binary data.
std::vector<ExportedFile> make_gltf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                    const ExportOptions& options);

}  // namespace interflect::detail
