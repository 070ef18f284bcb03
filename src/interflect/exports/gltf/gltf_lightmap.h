#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/gltf/gltf_document.h"

namespace interflect::detail {

/// Adds a scene with lightmaps: irradiance as MOZ_lightmap at TEXCOORD_1, or radiance of unlit materials. Returns
/// unclamped images beside the glTF file.
std::vector<ExportedFile> add_lightmap(GltfDocument& document, const std::filesystem::path& path, const Scene& scene,
                                       const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
