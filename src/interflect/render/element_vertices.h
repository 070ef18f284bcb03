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

/// Vertices shared by the elements at a point of one smooth surface.
class ElementVertices {
  public:
    /// T-vertex inside an edge of a larger leaf; interpolated linearly.
    struct Hanging {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction = 0.5f;  // 0 at ends[0], 1 at ends[1]
    };
    /// Vertex on a seam (SmoothSurfaces::Seam), inside an opposite leaf edge no longer than its own.
    struct Coupling {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction;
        float angle;  // weight of the leaf [rad]
    };

    /// @throws InputError for a forest of another scene.
    ElementVertices(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options = {});

    std::uint32_t count() const { return count_; }
    /// Returns the corners (0,0) (1,0) (1,1) (0,1) of a Cell; on triangles (0,0) (1,0) (0,1) and `none`.
    const std::array<std::uint32_t, 4>& corners(std::uint32_t e) const { return corners_[e]; }
    /// Hanging ends precede the vertex between them.
    const std::vector<Hanging>& hanging() const { return hanging_; }
    /// Each uses values from before all couplings.
    const std::vector<Coupling>& couplings() const { return couplings_; }
    const SmoothNormals& normals() const { return normals_; }

  private:
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<Hanging> hanging_;
    std::vector<Coupling> couplings_;
    SmoothNormals normals_;
    std::uint32_t count_ = 0;
};

/// Converts irradiance from leaves to vertices, after SmoothNormals. A vertex averages its leaves by angle, independent
/// of tessellation (Thuermer and Wuethrich 1998).
std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> irradiance);

}  // namespace interflect::detail
