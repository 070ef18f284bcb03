#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/exports/authored/authored_charts.h"

namespace interflect::detail {

/// Vertices of a primitive of a glTF file: first the file's own, then copies of vertices at which charts meet.
struct SplitVertices {
    /// Corner of a patch in a chart of the shape, which determines the lightmap coordinate of a vertex.
    struct Place {
        std::uint32_t chart = none, patch = 0, corner = 0;  ///< LightmapChart::patches[patch].corners[corner].
    };

    std::vector<Place> places;           ///< Place of each vertex; its chart is `none` if no triangle uses it.
    std::vector<std::uint32_t> copied;   ///< For each copy, the vertex of the file.
    std::vector<std::uint32_t> corners;  ///< Vertex of each corner, three per triangle.
};

/// @param primitive  Index in the mesh of the file. @param vertex_count  Number of vertices in the file.
SplitVertices split_vertices(const Model& model, const AuthoredShape& shape, std::uint32_t primitive,
                             std::uint32_t vertex_count);

}  // namespace interflect::detail
