#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"

namespace interflect::inline detail {

/// Irradiance probes as JSON: docs/exported-scenes.md has the keys.
std::vector<ExportedFile> make_probes_json(const std::filesystem::path& path, const Scene& scene,
                                           const Solution& solution, const ExportOptions& options);
/// The same with the coefficients as the layers of an OpenEXR image, a pixel a probe, and the JSON beside it.
std::vector<ExportedFile> make_probes_exr(const std::filesystem::path& path, const Scene& scene,
                                          const Solution& solution, const ExportOptions& options);

}  // namespace interflect::inline detail
