#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/render/smooth/element_vertices.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct MeshCorner {
    std::uint32_t point;  ///< Index into points().
    Parameters at;
    Rgb irradiance{0, 0, 0};  ///< Interpolated between vertices, as in SmoothField.
};
using MeshTriangle = std::array<MeshCorner, 3>;

/// Triangulation of the leaves without T-junctions, counter-clockwise as seen from the lit side. Splits quadrilaterals
/// along the diagonal with the smaller difference of irradiance (Baum et al. 1991), and larger polygons into fans.
class ElementMesh {
  public:
    /// Refers to its arguments.
    /// @param irradiance  One value per element; only leaves are used.
    /// @throws InputError for a forest of another scene.
    ElementMesh(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance);
    /// @param irradiance  One value per vertex.
    ElementMesh(const Scene& scene, const ElementForest& forest, ElementVertices vertices, std::vector<Rgb> irradiance);

    /// Returns the points, relative to Scene::origin [m]. triangulate() appends the centres of fans.
    const std::vector<V3f>& points() const { return points_; }
    /// Returns the corners of a leaf, with the points of other leaves on its edges. A leaf without area has fewer than
    /// three.
    std::vector<MeshCorner> outline(ElementIndex leaf) const;
    void triangulate(ElementIndex leaf, std::vector<MeshTriangle>& triangles);

  private:
    void number_points();
    void join_near_points();
    void add_points_on_edge(const MeshCorner& a, const MeshCorner& b, std::vector<MeshCorner>& outline) const;

    const ElementForest& forest_;
    ElementVertices vertices_;
    std::vector<Rgb> values_;  // irradiance of each vertex
    std::vector<V3f> points_;
    std::vector<std::array<std::uint32_t, 4>> corners_;  // point of each corner of each leaf
    std::vector<Boxed> tree_;                            // the joined points
    float tolerance_;                                    // [m]
};

}  // namespace interflect::detail
