#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/surfaces/smooth_surfaces.h"
#include "interflect/render/smooth/smooth_normals.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Vertices of the elements. Elements that meet at a point of a smooth surface share its vertex.
class ElementVertices {
  public:
    /// T-vertex inside an edge of a larger leaf. Its value is interpolated linearly between the ends of the edge.
    struct Hanging {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction = 0.5f;  // position on the edge: 0 at ends[0], 1 at ends[1]
    };
    /// Vertex on a seam (SmoothSurfaces::Seam), inside a leaf edge of the other side. That edge is not clearly longer
    /// than the vertex's own leaf edges, so its value is averaged with the value of the other side.
    struct Coupling {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction;
        float share;  // weight of the other side's value; the shares of a vertex sum to 1/2
    };

    /// @throws InputError for a forest of another scene.
    ElementVertices(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options = {});

    std::uint32_t count() const { return count_; }
    /// Returns the vertices at (0,0) (1,0) (1,1) (0,1) of an element's Cell; on triangles (0,0) (1,0) (0,1), then
    /// `none`.
    const std::array<std::uint32_t, 4>& corners(ElementIndex e) const { return corners_[e]; }
    /// The ends of an edge precede the vertices that hang on it.
    const std::vector<Hanging>& hanging() const { return hanging_; }
    /// All couplings are applied at once: they interpolate the uncoupled values.
    const std::vector<Coupling>& couplings() const { return couplings_; }
    const SmoothNormals& normals() const { return normals_; }

  private:
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<Hanging> hanging_;
    std::vector<Coupling> couplings_;
    SmoothNormals normals_;
    std::uint32_t count_ = 0;
};

}  // namespace interflect::detail
