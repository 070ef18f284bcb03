#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/geometry/box_tree.h"
#include "interflect/render/element_vertices.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// A corner of a triangle of an ElementMesh.
struct MeshCorner {
    std::uint32_t point;      ///< Index into ElementMesh::points().
    Parameters at;            ///< Where it is on the triangle's patch.
    Rgb irradiance{0, 0, 0};  ///< H, interpolated as by SmoothField.
};
using MeshTriangle = std::array<MeshCorner, 3>;

/// The leaves of a forest as triangles without T-junctions: what is a corner of any leaf is a corner of all leaves on
/// whose edges it lies, across patches and creases too, so that no rounding opens a crack between them. Corners that
/// are one to rounding (2^-20 of the largest coordinate) are one point. A leaf with such corners inside its edges
/// becomes a fan around its centre; other quadrilaterals are cut along the diagonal between whose ends irradiance
/// differs less (Baum et al. 1991).
class ElementMesh {
  public:
    /// @param irradiance  Of every element; only that of leaves counts.
    /// @throws InputError for a forest of another scene. The scene and the forest must outlive this.
    /// Cost: O(n log n) in the number of elements n; about 100 bytes each.
    ElementMesh(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance);

    /// Positions relative to Scene::origin [m]; triangulate() adds the centres of fans.
    const std::vector<V3f>& points() const { return points_; }
    /// The corners of a leaf, and what other leaves have as corners on its edges, counter-clockwise seen from the lit
    /// side; fewer than three where it has no area.
    std::vector<MeshCorner> outline(std::uint32_t leaf) const;
    /// Adds the triangles of a leaf to `triangles`, counter-clockwise seen from the lit side.
    void triangulate(std::uint32_t leaf, std::vector<MeshTriangle>& triangles);

  private:
    void number_points();
    void join_near_points();
    void add_points_on_edge(const MeshCorner& a, const MeshCorner& b, std::vector<MeshCorner>& outline) const;

    const ElementForest& forest_;
    ElementVertices vertices_;
    std::vector<Rgb> values_;  // of vertices_
    std::vector<V3f> points_;
    std::vector<std::array<std::uint32_t, 4>> corners_;  // of each leaf, its points
    std::vector<Boxed> tree_;                            // of the points that leaves have as corners
    float tolerance_;                                    // within which points are one [m]
};

}  // namespace interflect::inline detail
