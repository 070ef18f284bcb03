#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/exports/lightmap/earlier_lightmap.h"

namespace interflect::detail {

/// Adds a scene with lightmaps: irradiance by the extension MOZ_lightmap at TEXCOORD_1, or radiance by unlit materials.
/// Returns the unclamped images, which are files beside the glTF file. @param earlier  As of bake_charts().
std::vector<ExportedFile> add_lightmap(GltfDocument& document, const std::filesystem::path& path, const Scene& scene,
                                       const Solution& solution, const ExportOptions& options,
                                       const EarlierLightmap* earlier);

}  // namespace interflect::detail
