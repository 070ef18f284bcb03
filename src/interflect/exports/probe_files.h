#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::detail {

/// Exports irradiance probes as JSON (docs/files/exported-scenes.md).
std::vector<ExportedFile> make_probes_json(const std::filesystem::path& path, const Scene& scene,
                                           const Solution& solution, const ExportOptions& options);
/// Exports irradiance probes as OpenEXR with a layer for each coefficient and a pixel for each probe, and as JSON.
std::vector<ExportedFile> make_probes_exr(const std::filesystem::path& path, const Scene& scene,
                                          const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
