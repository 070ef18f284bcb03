#pragma once

#include <filesystem>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/authored/source_gltf.h"
#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/exports/lightmap/earlier_lightmap.h"

namespace interflect::detail {

/// Adds a lightmap to a glTF file, whose nodes, meshes, materials, textures and animations stay: a set of texture
/// coordinates (TEXCOORD_n, one above the highest of the materials), images, and a reference in each material. A mesh
/// that several nodes show is listed once for each, with the same accessors. Vertices are copied where charts meet.
/// Baked lights are removed unless LightmapOptions::keep_lights. Emission is multiplied by the exposure.
/// @param document  Result of source.document(). @param earlier  As of bake_charts(). @return  The images beside it.
std::vector<ExportedFile> add_lightmap(GltfDocument& document, SourceGltf& source, const std::filesystem::path& path,
                                       const Scene& scene, const Solution& solution, const ExportOptions& options,
                                       const EarlierLightmap* earlier);

}  // namespace interflect::detail
