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

/// Vertices of elements, shared by the elements at a point of one smooth surface. Creases, material borders and sides
/// of a face separate vertices. An edge's midpoint has a larger number than its ends. Independent of the number of
/// threads. Memory: 16 bytes per element and hanging vertex, 20 per coupling.
class ElementVertices {
  public:
    /// T-vertex inside an edge of a larger leaf; interpolated linearly.
    struct Hanging {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;  // of the leaf's edge or a part of it
        float fraction = 0.5f;              // position between ends[0] and ends[1]
    };
    /// Vertex on a seam (SmoothSurfaces::Seam), inside an opposite leaf edge no longer than its own. The leaf
    /// contributes by its angle.
    struct Coupling {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction;
        float angle;  // [rad]
    };

    /// @throws InputError if the forest belongs to another scene.
    ElementVertices(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options = {});

    std::uint32_t count() const { return count_; }
    /// Returns the corners in the patch's vertex order: (0,0) (1,0) (1,1) (0,1) of a Cell; on triangles three,
    /// (0,0) (1,0) (0,1).
    const std::array<std::uint32_t, 4>& corners(std::uint32_t e) const { return corners_[e]; }
    /// Hanging ends of an edge precede the vertex inside it.
    const std::vector<Hanging>& hanging() const { return hanging_; }
    /// In any order; each uses values before couplings.
    const std::vector<Coupling>& couplings() const { return couplings_; }
    const SmoothNormals& normals() const { return normals_; }

  private:
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<Hanging> hanging_;
    std::vector<Coupling> couplings_;
    SmoothNormals normals_;
    std::uint32_t count_ = 0;
};

/// Converts irradiance of leaves to irradiance of vertices, after SmoothNormals. A vertex averages its leaves by angle,
/// independent of tessellation (Thuermer and Wuethrich 1998). Hanging vertices are interpolated. Across a seam, leaves
/// of similar size differ by O(size^2).
std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> irradiance);

}  // namespace interflect::detail
