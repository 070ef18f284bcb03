#pragma once

#include <memory>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/export.h"
#include "interflect/exports/mesh/element_mesh.h"

namespace interflect::detail {

/// Elements with light at their vertices.
struct VertexLight {
    std::shared_ptr<const ElementForest> forest;
    ElementMesh mesh;         ///< Triangulates `forest`.
    std::vector<bool> shown;  ///< See shown_patches().
};

/// Computes light at the vertices of elements. With Shading::smooth they are the elements of the solution, else new
/// elements that are divided by VertexOptions.
/// @throws Stopped
VertexLight make_vertex_light(const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
