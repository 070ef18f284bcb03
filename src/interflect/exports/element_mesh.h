#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/geometry/box_tree.h"
#include "interflect/render/element_vertices.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct MeshCorner {
    std::uint32_t point;      ///< Index into ElementMesh::points().
    Parameters at;            ///< On the triangle's patch.
    Rgb irradiance{0, 0, 0};  ///< H, interpolated as by SmoothField.
};
using MeshTriangle = std::array<MeshCorner, 3>;

/// Triangulation of the leaves without T-junctions. A leaf corner on an edge of another leaf becomes a vertex of both,
/// also across patches and creases, so rounding opens no cracks. Corners within 2^-20 of the largest coordinate are
/// merged. Leaves with vertices inside their edges become fans around their centres. Other quadrilaterals are split
/// along the diagonal with the smaller difference of irradiance (Baum et al. 1991).
class ElementMesh {
  public:
    /// @param irradiance  One value per element; only leaves count.
    /// @throws InputError for a forest of another scene. Keeps references to both.
    /// Cost: O(n log n) for n elements; about 100 bytes each.
    ElementMesh(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance);

    /// Relative to Scene::origin [m]; triangulate() appends the centres of fans.
    const std::vector<V3f>& points() const { return points_; }
    /// Returns the vertices of a leaf, counter-clockwise seen from the lit side; fewer than three if it has no area.
    std::vector<MeshCorner> outline(std::uint32_t leaf) const;
    /// Appends triangles, counter-clockwise seen from the lit side.
    void triangulate(std::uint32_t leaf, std::vector<MeshTriangle>& triangles);

  private:
    void number_points();
    void join_near_points();
    void add_points_on_edge(const MeshCorner& a, const MeshCorner& b, std::vector<MeshCorner>& outline) const;

    const ElementForest& forest_;
    ElementVertices vertices_;
    std::vector<Rgb> values_;  // irradiance at vertices_
    std::vector<V3f> points_;
    std::vector<std::array<std::uint32_t, 4>> corners_;  // points of each leaf
    std::vector<Boxed> tree_;                            // over all leaf corners
    float tolerance_;                                    // merging distance [m]
};

}  // namespace interflect::detail
