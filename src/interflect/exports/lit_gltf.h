#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

/// Makes a binary glTF 2.0 file with y up (docs/files/export.md).
std::vector<ExportedFile> make_glb(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options);
/// Makes a glTF file in JSON, with embedded binary data.
std::vector<ExportedFile> make_gltf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                    const ExportOptions& options);

}  // namespace interflect::detail
