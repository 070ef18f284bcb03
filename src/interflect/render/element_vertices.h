#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth_normals.h"
#include "interflect/render/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Vertices of a forest's elements. Elements that meet at a point of one smooth surface share a vertex, regardless of
/// patch and level. Creases, material borders and the two sides of a face have separate vertices. The midpoint of an
/// edge has a larger number than its ends. Independent of the number of threads. Memory: 16 bytes per element and per
/// hanging vertex, 20 per coupling. Time is about linear.
class ElementVertices {
  public:
    /// T-vertex: a corner of smaller elements inside an edge of a larger leaf. Its value is interpolated linearly.
    struct Hanging {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;  // of the leaf's edge, or of a part of it
        float fraction = 0.5f;              // position between ends[0] and ends[1]
    };
    /// Vertex on a seam (SmoothSurfaces::Seam) inside an opposite leaf's edge that is not longer than its own edges.
    /// The leaf contributes to it by its angle.
    struct Coupling {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction;
        float angle;  // [rad]
    };

    /// @throws InputError if the forest belongs to another scene.
    ElementVertices(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options = {});

    std::uint32_t count() const { return count_; }
    /// Returns the corners of element e, leaf or not, in its patch's vertex order: (0,0) (1,0) (1,1) (0,1) of a
    /// quadrilateral's Cell; (0,0) (1,0) (0,1) and `none` for a triangle.
    const std::array<std::uint32_t, 4>& corners(std::uint32_t e) const { return corners_[e]; }
    /// Ordered: hanging ends of an edge precede the vertex inside it.
    const std::vector<Hanging>& hanging() const { return hanging_; }
    /// In any order. Each uses the values at its ends before couplings are applied.
    const std::vector<Coupling>& couplings() const { return couplings_; }
    const SmoothNormals& normals() const { return normals_; }

  private:
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<Hanging> hanging_;
    std::vector<Coupling> couplings_;
    SmoothNormals normals_;
    std::uint32_t count_ = 0;
};

/// Converts irradiance of leaves to irradiance of vertices. On curved surfaces it first varies within patches as their
/// normals do (SmoothNormals). A vertex has the mean over the leaves at it, weighted by angle. Angles do not depend on
/// the tessellation of a face (Thuermer and Wuethrich 1998). Hanging vertices are interpolated between the ends of
/// their edge, on which both sides then agree. Across a seam, leaves of similar size differ by the error of linear
/// interpolation, proportional to the square of their size.
std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> irradiance);

}  // namespace interflect::detail
