#pragma once

#include "interflect/export.h"
#include "interflect/exports/gltf/gltf_document.h"

namespace interflect::detail {

/// Adds a scene with unlit materials: display colours in COLOR_0, irradiance in _IRRADIANCE.
void add_vertex_light(GltfDocument& document, const Scene& scene, const Solution& solution,
                      const ExportOptions& options);

}  // namespace interflect::detail
