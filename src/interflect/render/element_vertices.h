#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Vertices of a forest's elements on the smooth surfaces of the scene. Elements that meet at a point of one smooth
/// surface share a vertex, regardless of patch and level. Surfaces have separate vertices at creases, at material
/// borders and on the two sides of a face. Vertices are numbered from 0; the midpoint of an edge follows the edge's
/// ends. The result is the same for any number of threads. Memory: 16 bytes per element, 16 per hanging vertex and 20
/// per coupling. Time is about linear.
class ElementVertices {
  public:
    /// T-vertex: a corner of smaller elements inside an edge of a larger leaf. A function that is linear along the edge
    /// has the interpolated value of its ends there.
    struct Hanging {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;  // of the leaf's edge, or of a part of it
        float fraction = 0.5f;              // position between ends[0] and ends[1]
    };
    /// Vertex on a seam (SmoothSurfaces::Seam) inside the edge of a leaf on the other side that is not longer than the
    /// vertex's own edges. The leaf does not have the vertex as a corner, but contributes to it by its angle.
    struct Coupling {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction;
        float angle;  // [rad]
    };

    /// @throws InputError if the forest belongs to another scene.
    ElementVertices(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options = {});

    std::uint32_t count() const { return count_; }
    /// Returns the corners of element e (leaf or not) in the vertex order of its patch: (0,0) (1,0) (1,1) (0,1) of the
    /// Cell of a quadrilateral; (0,0) (1,0) (0,1) and none for a triangle.
    const std::array<std::uint32_t, 4>& corners(std::uint32_t e) const { return corners_[e]; }
    /// Hanging vertices. If an end of an edge hangs, it precedes the vertex inside the edge.
    const std::vector<Hanging>& hanging() const { return hanging_; }
    /// Couplings in any order. Each uses the values at its ends before couplings are applied.
    const std::vector<Coupling>& couplings() const { return couplings_; }

  private:
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<Hanging> hanging_;
    std::vector<Coupling> couplings_;
    std::uint32_t count_ = 0;
};

/// Converts values of elements, of which only leaves are used, to values of vertices.
/// Most vertices: the mean over the leaves that have the vertex as a corner, weighted by their angles there. Angles do
/// not change when a face is triangulated (Thuermer and Wuethrich 1998); the result is independent of the tessellation.
/// Hanging vertices: interpolated between the ends of the edge. The leaves on both sides then agree along the edge.
/// Across a seam, leaves of similar size with separate vertices differ by the error of linear interpolation, which is
/// proportional to the square of their size.
std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> values);

}  // namespace interflect::inline detail
