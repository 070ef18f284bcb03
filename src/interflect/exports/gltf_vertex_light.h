#pragma once

#include "interflect/export.h"
#include "interflect/exports/gltf_document.h"

namespace interflect::inline detail {

/// Adds a solved scene with its light at the vertices of its elements (ElementMesh): unlit materials, display colours
/// in COLOR_0 and irradiance in _IRRADIANCE.
void add_vertex_light(GltfDocument& document, const Scene& scene, const Solution& solution,
                      const ExportOptions& options);

}  // namespace interflect::inline detail
