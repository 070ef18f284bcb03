#pragma once

#include <memory>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/export.h"
#include "interflect/exports/mesh/element_mesh.h"

namespace interflect::detail {

struct VertexLight {
    std::shared_ptr<const ElementForest> forest;
    ElementMesh mesh;         ///< Triangulates `forest`.
    std::vector<bool> shown;  ///< See shown_patches().
};

/// Light at the vertices of elements: the solution's for Shading::smooth; otherwise elements of its own, divided by
/// VertexOptions.
/// @throws Stopped
VertexLight make_vertex_light(const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
